// The axes of a Zarr array: their names, and the positions of the array's elements along them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ingest/axes/axis_place.h"
#include "ingest/zarr/meaning/multiscales.h"
#include "ingest/zarr/metadata/zarr_array.h"

namespace weir {

struct ArrayAxes {
  std::vector<AxisPlace> places;   ///< one for each axis, slowest first
  std::vector<std::string> types;  ///< "space", "channel" for each axis; empty texts if the metadata do not say it
  std::string note;  ///< names the transformations of an image that the places ignore; empty if there are none

  /// Returns the names and extents as text: "t 3, z 64, y 128, x 128".
  std::string text() const;
};

/// Returns the axes of `array`: by their names alone, or, if the array is the level of an image, by `level`.
ArrayAxes array_axes(const ZarrArray& array, const std::optional<FoundLevel>& level);

}  // namespace weir
