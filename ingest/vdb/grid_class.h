// The class and the background that a volume gets from a grid of either VDB format.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "format/layout/nvdb_type.h"

namespace weir {

/// Returns the class called `name`, for a grid with one real number a voxel: "level set" or "fog volume". NanoVDB's
/// validators accept no other class for such grids, so any other name gives unknown.
GridClass grid_class_called(std::string_view name);
/// Returns the class as above for the number that a NanoVDB file stores.
GridClass grid_class_stored(std::uint32_t number);
/// Returns "level set" or "fog volume", as OpenVDB writes them; empty if the class is unknown.
std::string_view grid_class_name(GridClass grid_class);

/// Returns SourceInfo::background for a grid with the background `stored` in its file. A level set keeps a finite
/// background: it is the value outside, beyond the narrow band, and any other value may read as inside. For other
/// classes, and for a background that is not finite, the survey finds the background, as for any other volume.
std::optional<float> background_to_keep(GridClass grid_class, double stored);

}  // namespace weir
