// Everything one picture of one grid needs, prepared on the host: leaf table,
// macrocells, transfer function, camera, light. Owns the tables that the
// RenderTask points into; the grid's bytes stay where they are mapped.
#pragma once

#include <cstdint>

#include "format/macrocells.h"
#include "format/nvdb_grid.h"
#include "format/scene.h"
#include "gpu/image_output.h"
#include "gpu/leaf_table.h"
#include "gpu/macrocell_grid.h"
#include "gpu/render_task.h"
#include "gpu/transfer_function.h"
#include "gpu/volume_sampler.h"

namespace weir {

struct RenderOptions {
  std::int32_t width = 960;   ///< pixels
  std::int32_t height = 720;  ///< pixels
  Filter filter = Filter::trilinear;
  std::uint64_t seed = 0;
  std::int64_t cell = kMacrocell;  ///< voxels along a macrocell's edge, at least
};

class RenderScene {
 public:
  /// `grid`'s bytes must outlive the object. Throws Error(input) where the grid is too large for the
  /// leaf table, Error(usage) for an unknown colormap, an impossible camera or a region outside the volume.
  RenderScene(const NvdbGrid& grid, const Scene& scene, const RenderOptions& options);
  RenderScene(const RenderScene&) = delete;
  RenderScene& operator=(const RenderScene&) = delete;

  const RenderTask<VolumeSampler>& task() const { return task_; }
  const LeafTable& leaf_table() const { return table_; }
  const MacrocellGrid& cells() const { return cells_; }
  const TransferFunction& transfer_function() const { return transfer_; }
  ToneMapping tone() const { return tone_; }

 private:
  Box shown(const Scene& scene) const;
  std::vector<Box> framed(const Scene& scene) const;

  LeafTable table_;
  MacrocellGrid cells_;
  TransferFunction transfer_;
  std::vector<float> majorants_;
  RenderTask<VolumeSampler> task_;
  ToneMapping tone_;
};

}  // namespace weir
