// One axis of a block plan: how its leaves are cut into blocks, and how many chunks a cut decodes more than once.
#pragma once

#include <cstdint>
#include <vector>

namespace weir {

/// Lengths are in leaves unless the comment says voxels.
struct BlockAxis {
  std::int64_t lo = 0;          ///< domain, voxels
  std::int64_t hi = 0;          ///< domain, voxels
  std::int64_t first = 0;       ///< global coordinate of the first leaf
  std::int64_t count = 0;       ///< leaves
  std::int64_t chunk = 0;       ///< voxels, zero if not chunked
  std::int64_t chunk_edge = 0;  ///< index of any chunk's edge, voxels
  std::int64_t unit = 1;        ///< smallest block that ends with a chunk; 1 if no block does
  std::int64_t size = 1;        ///< the block's length as chosen so far

  /// Makes an axis of a domain [lo, hi), hi > lo, with blocks one unit long.
  BlockAxis(std::int64_t domain_lo, std::int64_t domain_hi, std::int64_t chunk_voxels, std::int64_t edge);

  /// Returns the smallest multiple of the unit that holds a lower node's width.
  std::int64_t step() const;
  bool whole() const { return size >= count; }
  /// Returns how many leaves of the first block lie before the domain's first leaf. Blocks lie on multiples of their
  /// size from the global origin, or from a chunk's edge.
  std::int64_t lead() const;
  std::int64_t blocks() const;
  /// begin() and end() return the lattice positions of block k.
  std::int64_t begin(std::int64_t k) const;
  std::int64_t end(std::int64_t k) const;
  std::int64_t voxels(std::int64_t k) const;
  /// Returns the voxels of the longest block, which is one in the middle if there is one.
  std::int64_t longest() const;
  /// Returns the number of chunk decodes in the first `most_blocks` blocks, divided by the number of chunks in them.
  /// Returns 1 if not chunked.
  double amplification(std::int64_t most_blocks) const;
};

/// One way to cut an axis.
struct AxisCut {
  std::int64_t size = 1;     ///< leaves
  std::int64_t longest = 0;  ///< voxels of the longest block
  double amplification = 1;
};

/// Returns the cuts worth considering, from short to long: each longer cut decodes fewer chunks twice. The last cut
/// is the whole axis, or a shorter cut that decodes no chunk twice either.
std::vector<AxisCut> useful_cuts(BlockAxis axis);

}  // namespace weir
