// Named colour maps: a few control points each, interpolated in sRGB and returned in linear light.
#pragma once

#include <string_view>
#include <vector>

#include "gpu/math/vector3.h"

namespace weir {

/// The sRGB transfer function (IEC 61966-2-1) and its inverse, for one channel, [0, 1] to [0, 1].
float srgb_from_linear(float linear);
float linear_from_srgb(float srgb);

/// Returns the names in kColormapNames as a list.
std::vector<std::string_view> colormap_names();
/// Returns linear RGB at `entries` evenly spaced points of [0, 1]. Throws Error(usage), listing the names, if `name`
/// is unknown.
std::vector<Float3> colormap(std::string_view name, std::size_t entries);

}  // namespace weir
