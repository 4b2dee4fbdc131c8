// One axis of a block plan: how its leaves are cut, and what a cut costs in chunks
// decoded more than once.
#pragma once

#include <cstdint>
#include <vector>

namespace weir {

/// Lengths in leaves, except where they say voxels.
struct BlockAxis {
  std::int64_t lo = 0;          ///< domain, voxels
  std::int64_t hi = 0;          ///< domain, voxels
  std::int64_t first = 0;       ///< global coordinate of the first leaf
  std::int64_t count = 0;       ///< leaves
  std::int64_t chunk = 0;       ///< voxels, zero where not chunked
  std::int64_t chunk_edge = 0;  ///< index of any chunk's edge, voxels
  std::int64_t unit = 1;        ///< smallest block that ends with a chunk; 1 where there is none
  std::int64_t size = 1;        ///< the block's length as chosen so far

  /// An axis of a domain [lo, hi), hi > lo, blocks one unit long.
  BlockAxis(std::int64_t domain_lo, std::int64_t domain_hi, std::int64_t chunk_voxels, std::int64_t edge);

  /// Smallest multiple of the unit that holds a lower node's width.
  std::int64_t step() const;
  bool whole() const { return size >= count; }
  /// Leaves of the first block before the domain's first leaf. Blocks lie on multiples of their size
  /// from the global origin, or from a chunk's edge.
  std::int64_t lead() const;
  std::int64_t blocks() const;
  /// Lattice positions of block k.
  std::int64_t begin(std::int64_t k) const;
  std::int64_t end(std::int64_t k) const;
  std::int64_t voxels(std::int64_t k) const;
  /// Voxels of the longest block: one in the middle where there is one.
  std::int64_t longest() const;
  /// Chunks decoded, the first `most_blocks` blocks together, over chunks there are in them; 1 where not
  /// chunked.
  double amplification(std::int64_t most_blocks) const;
};

/// One way to cut an axis.
struct AxisCut {
  std::int64_t size = 1;     ///< leaves
  std::int64_t longest = 0;  ///< voxels of the longest block
  double amplification = 1;
};

/// The cuts worth considering, from short to long: each longer one decodes fewer chunks twice. The last
/// one is the whole axis, or a shorter one that decodes no chunk twice either.
std::vector<AxisCut> useful_cuts(BlockAxis axis);

}  // namespace weir
