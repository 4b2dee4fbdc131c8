// The warning about an iso surface that no voxel can reach.
#pragma once

#include "format/leaf/bounds.h"
#include "format/sidecar/scene.h"

namespace weir {

/// Returns "the iso value 0.74 lies outside the values, 0 .. 0.7399: the picture shows no surface", with enough digits
/// to tell the iso value from the end of the range. Also warns if the iso value is the lowest of `values`, so that no
/// value is below it, or if `scene` names no iso value and all values are equal. Empty if `scene` draws no surface or
/// if values lie on both sides.
std::string surface_warning(const Scene& scene, const MinMax& values);

}  // namespace weir
