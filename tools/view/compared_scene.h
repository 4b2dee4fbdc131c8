// A scene of a file, for the one that it is compared with: a clip box counts voxels, and the two lie in one world.
#pragma once

#include <optional>

#include "format/sidecar/scene.h"
#include "gpu/scene/scene_camera.h"

namespace weir {

/// The scene with its region, which counts voxels of `frame`, in voxels of `other`: the whole ones whose faces are
/// nearest to the same places in the world, at least one along each axis. None where `other` has no voxel there.
std::optional<Scene> scene_of_other(const Scene& scene, const GridFrame& frame, const GridFrame& other);

/// What is behind the volume of the scene, and nothing of the volume.
Scene without_volume(Scene scene);

}  // namespace weir
