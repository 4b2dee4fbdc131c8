// Everything that one picture of one grid needs on the CPU: leaf table, macrocells and the set-up that a scene asks
// for. Owns the tables that the RenderTask points into; the grid's bytes stay mapped.
#pragma once

#include "gpu/render/render_setup.h"
#include "gpu/volume/leaf_table.h"

namespace weir {

class RenderScene {
 public:
  /// `grid`'s bytes must outlive the object. Throws Error(input) if the grid is too large for the leaf table, and the
  /// errors of RenderSetup.
  RenderScene(const NvdbGrid& grid, const Scene& scene, const RenderOptions& options);
  RenderScene(const RenderScene&) = delete;
  RenderScene& operator=(const RenderScene&) = delete;

  const RenderTask<VolumeSampler>& task() const { return task_; }
  const LeafTable& leaf_table() const { return table_; }
  const MacrocellGrid& cells() const { return cells_; }
  const TransferFunction& transfer_function() const { return setup_.transfer_function(); }
  ToneMapping tone() const { return setup_.tone(); }

 private:
  LeafTable table_;
  MacrocellGrid cells_;
  RenderSetup setup_;
  RenderTask<VolumeSampler> task_;
};

}  // namespace weir
