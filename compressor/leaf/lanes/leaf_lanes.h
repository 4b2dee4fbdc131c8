// Leaves that repeat their values, surveyed eight at once: what summarize_leaf and summarize_widths find of each, to
// the bit, from its distinct values.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "compressor/leaf/lanes/lane_shape.h"
#include "compressor/leaf/leaf_row.h"

namespace weir {

/// Up to kLeafLanes leaves in groups of the same size. One per thread.
class LeafLanes {
 public:
  /// Whether a leaf of these values may be added: finite ones of which two differ.
  static bool takes(std::span<const float> distinct);

  /// Empties it for leaves in groups of `by` voxels, which suit (LaneShape).
  void begin(const Index3& by);
  void clear() { size_ = 0; }
  /// A leaf of so many `distinct` values, x fastest, that it takes.
  void add(std::span<const float> distinct);
  std::size_t size() const { return size_; }
  bool full() const { return size_ == kLeafLanes; }
  const Index3& by() const { return by_; }
  std::span<const float> distinct(std::size_t leaf) const { return {rows_[leaf].data(), shape_.values()}; }

  /// Sets all but sample and digest of the rows of the leaves, in the order in which they were added; what
  /// summarize_widths finds where `widths`.
  void summarize(bool widths, std::span<LeafRow> rows);

 private:
  Index3 by_;
  LaneShape shape_;
  std::size_t size_ = 0;
  std::array<std::array<float, kMostLaneValues>, kLeafLanes> rows_;
};

}  // namespace weir
