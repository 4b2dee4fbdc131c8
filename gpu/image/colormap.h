// Named colour maps: a few control points each, interpolated in sRGB and handed
// out in linear light.
#pragma once

#include <string_view>
#include <vector>

#include "gpu/math/vector3.h"

namespace weir {

/// sRGB transfer function (IEC 61966-2-1), one channel, [0, 1] to [0, 1].
float srgb_from_linear(float linear);
float linear_from_srgb(float srgb);

/// Those of kColormapNames, one by one.
std::vector<std::string_view> colormap_names();
/// Linear RGB at `entries` equal distances over [0, 1]. Throws Error(usage) listing the names where
/// `name` is none of them.
std::vector<Float3> colormap(std::string_view name, std::size_t entries);

}  // namespace weir
