// Finds the part of a block to read when only some of its leaves are needed.
#pragma once

#include "format/base/index.h"

namespace weir {

/// Collects the leaves that are needed, as positions of the leaf lattice. Rows along x are read whole, because files
/// are read by rows.
class RowsToRead {
 public:
  explicit RowsToRead(const Box& block) : block_(block), needed_{block.hi, block.lo} {}

  void add(const Index3& leaf) {
    needed_.lo = min(needed_.lo, leaf);
    needed_.hi = max(needed_.hi, leaf + Index3{1, 1, 1});
  }
  /// Returns the box of leaves to read; empty if no leaf was added.
  Box box() const {
    if (needed_.empty()) return needed_;
    return {{block_.lo.x, needed_.lo.y, needed_.lo.z}, {block_.hi.x, needed_.hi.y, needed_.hi.z}};
  }

 private:
  Box block_;
  Box needed_;
};

}  // namespace weir
