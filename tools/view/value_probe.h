// Finds the voxel that a viewer points at in a picture of a volume.
#pragma once

#include <optional>

#include "format/base/index.h"
#include "format/nanovdb/nvdb_grid.h"
#include "format/sidecar/scene.h"
#include "gpu/scene/camera.h"

namespace weir {

struct ProbedVoxel {
  Index3 voxel;   ///< in index space
  Double3 world;  ///< its centre
  float value = 0;
};

/// Returns the voxel that gives the picture's point (x, y), in [0, 1] from the upper left, most of its colour. For a
/// surface that is the first voxel of the surface, for `mip` the voxel of the largest value, otherwise the voxel with
/// the largest share of the pixel's light. `camera` is the picture's, `range` the finite range of the values,
/// `background` as in RenderOptions. nullopt if nothing is seen there. Reads the voxels along one ray, a block at a
/// time. Throws as NvdbGrid::decode_block.
std::optional<ProbedVoxel> probe_voxel(const NvdbGrid& grid, const Scene& scene, const Camera& camera,
                                       const MinMax& range, float background, double x, double y);

/// Returns the value of the voxel at a place in the world; nullopt outside the grid's box. Throws as NvdbGrid::value.
std::optional<float> value_at(const NvdbGrid& grid, const Double3& world);

}  // namespace weir
