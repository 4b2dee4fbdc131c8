// Axis names and coordinates by HDF5's dimension scales, as NetCDF-4 writes its
// dimensions and coordinate variables.
#pragma once

#include <hdf5.h>

#include <span>
#include <vector>

#include "ingest/axes/axis_place.h"

namespace weir {

/// Fills labels by the names of the scales of `dataset` (attribute DIMENSION_LIST), else by DIMENSION_LABELS; units and
/// is_time by the scales' attributes; spacing and origin, where they are not set, by their values. Irregular
/// coordinates get a note instead, and are kept, as those of a time are. Falling coordinates get the spacing's size and
/// the lowest coordinate as origin, as elements in reverse order have them, and a note. Where an axis and its
/// scale may grow and that is longer, the first coordinates are its own, and the rest is `unwritten`. The caller holds
/// Hdf5Lock.
void place_by_scales(hid_t dataset, std::span<AxisPlace> axes);

/// Whether a dataset only stands for a dimension of NetCDF that has no coordinates: it holds no values. Calls
/// check_attribute_bytes() first.
bool is_bare_dimension(hid_t dataset);

/// The numbers of a dataset of up to kMaxCoordinates of them, in one axis or none, as its attributes mean them
/// (value_meaning()): unpacked, NaN where one is missing. Empty where it is another, its packed chunks have more than
/// kMaxCoordinateChunk, or an attribute leaves their meaning open. Throws Error(input) where they cannot be read. The
/// caller holds Hdf5Lock.
std::vector<double> coordinate_values(hid_t dataset);

}  // namespace weir
