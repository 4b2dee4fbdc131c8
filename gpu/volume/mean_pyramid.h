// Levels of detail of a volume on the CPU: means of its voxels, kept in memory.
#pragma once

#include <vector>

#include "gpu/volume/block_lattice.h"
#include "gpu/volume/cached_blocks.h"
#include "gpu/volume/dense_volume.h"
#include "gpu/volume/levelled_volume.h"
#include "gpu/volume/macrocell_grid.h"

namespace weir {

class MeanPyramid {
 public:
  /// Makes the levels from `first` (at most kMostFinest) on of a grid over `domain`, from the voxels of `table`.
  /// `threads` 0 means all of the machine's.
  MeanPyramid(const Box& domain, const LeafTableView& table, int first, int threads);
  /// For a packed grid, whose coded blocks are decoded one after the other.
  MeanPyramid(const Box& domain, const CachedBlocks& blocks, int first, int threads);

  /// For a dense volume.
  MeanPyramid(const Box& domain, const DenseView& voxels, int first, int threads);

  LevelsView<DenseSampler> view() const;
  /// Returns, for each of `cells`, the bounds of the values that look-ups with this choice of levels may read in it
  /// (level_bounds.h, also for `drafts`).
  std::vector<MinMax> bounds(const MacrocellGrid& cells, const LevelChoice& choice, int threads,
                             bool drafts = false) const;
  int first() const { return first_; }

 private:
  template <class Blocks>
  void fill(const Blocks& blocks, int threads);
  template <class Blocks>
  void fill_finest(const Blocks& blocks);
  /// Makes `level` from the next finer level.
  void reduce_level(int level);
  /// Replaces NaN texels as texel_beside_finite() says.
  void fill_beside_finite(int level);

  LevelLattice lattice_;
  int first_;
  std::vector<std::vector<float>> levels_;
};

/// Returns the level lattice of a grid's index box.
inline LevelLattice level_lattice(const Box& domain) {
  const BlockLattice blocks = block_lattice(domain);
  return {blocks.shift, blocks.extent};
}

}  // namespace weir
