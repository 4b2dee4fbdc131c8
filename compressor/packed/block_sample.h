// Which blocks of a volume are looked at first, or more closely: enough to tell what a budget will buy. Rows of blocks
// along x, which a file is read by, spread evenly over the volume.
#pragma once

#include <cstdint>
#include <vector>

#include "format/base/index.h"

namespace weir {

class BlockSample {
 public:
  /// Of a volume with those leaves: one block in 64 or so, but a thousand at least and some eight thousand at most.
  explicit BlockSample(const NodeLattice& leaves);

  /// Whether the block at that position of the lattice is one of them.
  bool has(const Index3& leaf) const;
  /// All of them, as rows of lattice positions in the lattice's order, no two of which have a block in common.
  std::vector<Box> rows() const;
  std::int64_t size() const;

 private:
  Box row_at(std::int64_t place) const;

  Index3 count_;                      // blocks along each axis
  std::int64_t row_length_;           // blocks, the last along x excepted
  std::int64_t rows_along_x_;         // in one line of blocks
  std::vector<std::int64_t> places_;  // of rows among all of them, x fastest; rising
};

}  // namespace weir
