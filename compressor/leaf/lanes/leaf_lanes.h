// Surveys eight leaves at once that repeat their values. From the distinct values of each leaf it finds, bit for bit,
// what summarize_leaf and summarize_widths find.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "compressor/leaf/lanes/lane_shape.h"
#include "compressor/leaf/leaf_row.h"

namespace weir {

/// Holds up to kLeafLanes leaves with groups of the same size. One object per thread.
class LeafLanes {
 public:
  /// Returns whether a leaf of these values may be added: all must be finite, and at least two must differ.
  static bool takes(std::span<const float> distinct);

  /// Removes all leaves and begins anew for leaves in groups of `by` voxels. LaneShape::suits(by) must be true.
  void begin(const Index3& by);
  void clear() { size_ = 0; }
  /// Adds a leaf with these distinct values, x fastest. takes(distinct) must be true, and full() false.
  void add(std::span<const float> distinct);
  std::size_t size() const { return size_; }
  bool full() const { return size_ == kLeafLanes; }
  const Index3& by() const { return by_; }
  std::span<const float> distinct(std::size_t leaf) const { return {rows_[leaf].data(), shape_.values()}; }

  /// Sets the rows of the leaves, in the order of add(), except `sample` and `digest`. If `widths` is true, also sets
  /// what summarize_widths finds.
  void summarize(bool widths, std::span<LeafRow> rows);

 private:
  Index3 by_;
  LaneShape shape_;
  std::size_t size_ = 0;
  std::array<std::array<float, kMostLaneValues>, kLeafLanes> rows_;
};

}  // namespace weir
