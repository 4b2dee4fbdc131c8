// What is said of an iso surface that no voxel can reach.
#pragma once

#include "format/leaf/bounds.h"
#include "format/sidecar/scene.h"

namespace weir {

/// "the iso value 0.74 lies outside the values, 0 .. 0.7399: the picture shows no surface", with as many digits as tell
/// the value from the end that it lies beyond; or that it is the lowest of `values`, which none of them is below; or,
/// where `scene` names no value, that there is one alone. Empty where `scene` draws no surface, and where there are
/// values on both sides.
std::string surface_warning(const Scene& scene, const MinMax& values);

}  // namespace weir
