// The sample of blocks that is looked at first, or more closely, to tell what a budget will buy. The sample consists of
// rows of blocks along x, as files are read, spread evenly over the volume.
#pragma once

#include <cstdint>
#include <vector>

#include "format/base/index.h"

namespace weir {

class BlockSample {
 public:
  /// The most blocks of a row. A sample of longer rows has fewer rows and tells less about sparse volumes.
  static constexpr std::int64_t kLongestRow = 64;

  /// Samples a volume with these `leaves`: about one block in 64, at least about 1,000 and at most about 8,000 blocks.
  explicit BlockSample(const NodeLattice& leaves);

  /// Returns whether the sample has the block at lattice position `leaf`. The answer is the same for all blocks of a
  /// line along x between two neighbouring multiples of row_length().
  bool has(const Index3& leaf) const;
  /// Returns the blocks of a row. The last row along x may be shorter.
  std::int64_t row_length() const { return row_length_; }
  /// Returns the sampled blocks as disjoint rows of lattice positions, in the lattice's order.
  std::vector<Box> rows() const;
  std::int64_t size() const;

 private:
  Box row_at(std::int64_t place) const;

  Index3 count_;                      // blocks along each axis
  std::int64_t row_length_;           // blocks of a row; the last row along x may be shorter
  std::int64_t rows_along_x_;         // in one line of blocks
  std::vector<std::int64_t> places_;  // of rows among all of them, x fastest; rising
};

}  // namespace weir
