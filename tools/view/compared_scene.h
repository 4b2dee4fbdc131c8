// Converts a scene of one file for the file that it is compared with. A clip box counts voxels, so it is converted
// through the world, which both files share.
#pragma once

#include <optional>

#include "format/sidecar/scene.h"
#include "gpu/scene/scene_camera.h"

namespace weir {

/// Returns `scene` with its region, which counts voxels of `frame`, in voxels of `other`: whole voxels whose faces are
/// nearest to the same places in the world, at least one along each axis. nullopt if `other` has no voxel there.
std::optional<Scene> scene_of_other(const Scene& scene, const GridFrame& frame, const GridFrame& other);

/// Returns the scene with only what lies behind the volume, without the volume.
Scene without_volume(Scene scene);

}  // namespace weir
