// Reads axis names and coordinates from HDF5's dimension scales, as NetCDF-4 writes its dimensions and coordinate
// variables.
#pragma once

#include <hdf5.h>

#include <span>
#include <vector>

#include "ingest/axes/axis_place.h"

namespace weir {

/// Fills the labels from the names of the scales of `dataset` (attribute DIMENSION_LIST), otherwise from
/// DIMENSION_LABELS. Fills units and is_time from the scales' attributes, and spacing and origin, if they are not
/// set, from the scales' values. Irregular coordinates get a note instead; they are kept, as a time's coordinates
/// are. Falling coordinates get a note, the size of the spacing, and the lowest coordinate as origin, which is right
/// for elements in reverse order. If an axis and its scale may grow and the scale is longer, the axis has the first
/// coordinates, and `unwritten` counts the rest. The caller holds Hdf5Lock.
void place_by_scales(hid_t dataset, std::span<AxisPlace> axes);

/// Returns whether a dataset only stands for a NetCDF dimension without coordinates, and so holds no values. Calls
/// check_attribute_bytes() first.
bool is_bare_dimension(hid_t dataset);

/// Returns the numbers of a dataset with at most kMaxCoordinates values and at most one axis. The numbers are
/// unpacked as the attributes say (value_meaning()), with NaN for missing numbers. Returns an empty vector for any
/// other dataset, if packed chunks have more than kMaxCoordinateChunk, or if an attribute leaves the meaning open.
/// Throws Error(input) if the numbers cannot be read. The caller holds Hdf5Lock.
std::vector<double> coordinate_values(hid_t dataset);

}  // namespace weir
