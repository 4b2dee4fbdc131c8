// What is said of an iso surface that no voxel can reach.
#pragma once

#include "format/leaf/bounds.h"
#include "format/sidecar/scene.h"

namespace weir {

/// "the iso value 0.74 lies outside the values, 0 .. 0.7399: the picture shows no surface", with as many digits as tell
/// the value from the end that it lies beyond; empty where `scene` draws no surface, names no value, or `values` hold
/// it.
std::string surface_warning(const Scene& scene, const MinMax& values);

}  // namespace weir
