// The axes of a Zarr array: what they are called, and where its elements lie along them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ingest/axes/axis_place.h"
#include "ingest/zarr/meaning/multiscales.h"
#include "ingest/zarr/metadata/zarr_array.h"

namespace weir {

struct ArrayAxes {
  std::vector<AxisPlace> places;   ///< as many as the array has, slowest first
  std::vector<std::string> types;  ///< of each, "space", "channel"; empty texts where the metadata do not say it
  std::string note;                ///< which transformations of an image are not in the places; else empty

  /// "t 3, z 64, y 128, x 128".
  std::string text() const;
};

/// The axes by their names alone, those of `level`, where an image has the array as one, by that.
ArrayAxes array_axes(const ZarrArray& array, const std::optional<FoundLevel>& level);

}  // namespace weir
