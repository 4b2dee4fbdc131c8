// From the coordinates of an axis to its spacing and origin.
#pragma once

#include <cstddef>
#include <vector>

#include "ingest/axes/axis_place.h"

namespace weir {

/// Coordinates of an axis that are looked at, at most: 8 MiB of them.
inline constexpr std::size_t kMaxCoordinates = std::size_t{1} << 20U;
/// Elements of a chunk of coordinates that is unpacked for them, at most.
inline constexpr std::size_t kMaxCoordinateChunk = 2 * kMaxCoordinates;
/// How far a coordinate may lie from where regular spacing puts it, in spacings: coordinates in degrees or
/// kilometres are often rounded to a few digits.
inline constexpr double kRegularTolerance = 1e-3;

/// Sets spacing and origin of `axis` by the coordinates of its elements, each of which was rounded by `precision` of
/// itself. Irregular coordinates get a note instead, a single one gives the origin alone; falling ones get the
/// spacing's size and the lowest coordinate as origin, as elements in reverse order have them, and a note; a time never
/// does. Coordinates that are irregular, or of a time, are kept. Where some are not finite there is a note alone.
void place_by_coordinates(std::vector<double> coordinates, double precision, AxisPlace& axis);

}  // namespace weir
