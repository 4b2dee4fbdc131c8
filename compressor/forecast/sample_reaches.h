// The values that lookups around the leaves of a sample can touch in the volume that the sample was taken from.
#pragma once

#include <atomic>
#include <vector>

#include "compressor/forecast/sample_plan.h"
#include "format/base/index.h"
#include "format/leaf/bounds.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Bounds of the finite values of each leaf and of the voxels around it, as find_reaches finds them for a volume. Takes
/// 8 bytes per leaf.
class SampleReaches {
 public:
  /// Reads the cells of `plan` from `volume`, with one voxel around them, in rows of leaves. `cancel` may be null.
  /// Throws what reading throws, and Error(interrupted) when `*cancel` is set.
  SampleReaches(VolumeSource& volume, const SamplePlan& plan, const std::atomic<bool>* cancel);

  /// Returns the bounds for the leaf of the sample that holds `voxel`; min > max if no value is finite.
  const MinMax& at(const Index3& voxel) const { return reaches_[index_of(voxel)]; }

 private:
  std::size_t index_of(const Index3& voxel) const {
    return static_cast<std::size_t>(leaves_.linear(floor_div(voxel, kLeafDim) - leaves_.first));
  }
  void read_piece(VolumeSource& volume, const Box& piece, const Index3& corner);

  NodeLattice leaves_;
  std::vector<MinMax> reaches_;
};

}  // namespace weir
