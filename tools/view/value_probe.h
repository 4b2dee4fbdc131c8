// Which voxel somebody means who points at a picture of a volume.
#pragma once

#include <optional>

#include "format/base/index.h"
#include "format/nanovdb/nvdb_grid.h"
#include "format/sidecar/scene.h"
#include "gpu/scene/camera.h"

namespace weir {

struct ProbedVoxel {
  Index3 voxel;   ///< of index space
  Double3 world;  ///< its centre
  float value = 0;
};

/// The voxel that gives the point (x, y) of the picture, both in [0, 1] from the upper left, most of its colour: of a
/// surface the first one it passes, of the largest value that voxel, else the one whose light is the largest share of
/// the pixel's. `camera` is the picture's, `range` of the values, finite, `background` as RenderOptions has it. None
/// where nothing is seen there. Looks at the voxels along one ray, a block at a time. Throws as
/// NvdbGrid::decode_block.
std::optional<ProbedVoxel> probe_voxel(const NvdbGrid& grid, const Scene& scene, const Camera& camera,
                                       const MinMax& range, float background, double x, double y);

/// The value of the voxel at a place in the world; none outside the grid's box. Throws as NvdbGrid::value.
std::optional<float> value_at(const NvdbGrid& grid, const Double3& world);

}  // namespace weir
