// The class and the background that a grid of either VDB format gives its volume.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "format/layout/nvdb_type.h"

namespace weir {

/// Of a grid of one real number a voxel that is called `name`: "level set" or "fog volume". NanoVDB's validators take
/// no other class; it becomes unknown.
GridClass grid_class_called(std::string_view name);
/// The same of the number that a NanoVDB file stores.
GridClass grid_class_stored(std::uint32_t number);
/// "level set" or "fog volume", as OpenVDB writes them; empty where it is unknown.
std::string_view grid_class_name(GridClass grid_class);

/// SourceInfo::background of a grid whose file says `stored`. Beyond the narrow band a level set is its background
/// outside: any other one may read as inside. The survey finds that of other classes, as of any other volume, and one
/// that is not finite.
std::optional<float> background_to_keep(GridClass grid_class, double stored);

}  // namespace weir
