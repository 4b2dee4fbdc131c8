// Computes the spacing and origin of an axis from its coordinates.
#pragma once

#include <cstddef>
#include <vector>

#include "ingest/axes/axis_place.h"

namespace weir {

/// The most coordinates of an axis that are read (8 MiB).
inline constexpr std::size_t kMaxCoordinates = std::size_t{1} << 20U;
/// The most elements of a chunk that is unpacked to read coordinates.
inline constexpr std::size_t kMaxCoordinateChunk = 2 * kMaxCoordinates;
/// How far, in spacings, a coordinate may lie from its place in a regular spacing. Coordinates in degrees or
/// kilometres are often rounded to a few digits.
inline constexpr double kRegularTolerance = 1e-3;

/// Sets spacing and origin of `axis` from the coordinates of its elements, each rounded by `precision` relative to
/// its value. Irregular coordinates get a note instead. A single coordinate gives the origin alone. Falling
/// coordinates get a positive spacing, the lowest coordinate as origin (the order of reversed elements) and a note,
/// but not on a time axis. Irregular coordinates and those of a time are kept. If some coordinates are not finite,
/// there is only a note.
void place_by_coordinates(std::vector<double> coordinates, double precision, AxisPlace& axis);

}  // namespace weir
