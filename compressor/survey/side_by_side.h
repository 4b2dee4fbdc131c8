// Holds leaves of a block that repeat their values, until there are enough to make their rows together (LeafLanes).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "compressor/leaf/lanes/leaf_lanes.h"
#include "format/io/digest.h"

namespace weir {

/// Not thread-safe.
class SideBySide {
 public:
  struct Leaf {
    std::size_t at;       ///< index in the block
    std::int64_t linear;  ///< linear index in the leaf lattice
    float sample;
    Digest digest;
  };

  explicit SideBySide(bool widths) : widths_(widths) {}

  /// Holds a leaf that LeafLanes::takes(). If the leaf cannot join the held leaves, first calls
  /// visit(leaf, distinct, row) for each held leaf and releases them.
  template <typename Visit>
  void add(const Leaf& leaf, std::span<const float> distinct, const Index3& by, const Visit& visit) {
    if (lanes_.full() || (lanes_.size() > 0 && lanes_.by() != by)) finish(visit);
    if (lanes_.size() == 0) lanes_.begin(by);
    leaves_[lanes_.size()] = leaf;
    lanes_.add(distinct);
  }

  /// Calls visit(leaf, distinct, row) for all held leaves and releases them.
  template <typename Visit>
  void finish(const Visit& visit) {
    std::array<LeafRow, kLeafLanes> rows;
    lanes_.summarize(widths_, rows);
    for (std::size_t i = 0; i < lanes_.size(); ++i) {
      rows[i].sample = leaves_[i].sample;
      rows[i].digest = leaves_[i].digest;
      visit(leaves_[i], lanes_.distinct(i), rows[i]);
    }
    lanes_.clear();
  }

 private:
  bool widths_;
  LeafLanes lanes_;
  std::array<Leaf, kLeafLanes> leaves_;
};

}  // namespace weir
