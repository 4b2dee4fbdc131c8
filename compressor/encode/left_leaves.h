// The values of the kept leaves of a region that a device has left to the host.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "format/base/index.h"
#include "format/leaf/leaf_codec.h"

namespace weir {

class LeftLeaves {
 public:
  /// `box`: lattice positions; all leaves must lie in it.
  explicit LeftLeaves(const Box& box) : box_(box), place_(static_cast<std::size_t>(box.voxels()), kNone) {}

  void add(const Index3& leaf) {
    place_[at(leaf)] = static_cast<std::int32_t>(leaves_.size());
    leaves_.push_back(leaf);
  }
  const std::vector<Index3>& leaves() const { return leaves_; }

  /// Returns the values of all leaves, 512 per leaf in the order of a leaf, in the order of add(). A voxel outside the
  /// volume has the value of the nearest voxel inside. The caller sizes and fills the vector.
  std::vector<float>& values() { return values_; }
  /// Returns the 512 values of a leaf that add() was given.
  const float* find(const Index3& leaf) const {
    return values_.data() + static_cast<std::size_t>(place_[at(leaf)]) * kLeafVoxels;
  }

 private:
  static constexpr std::int32_t kNone = -1;
  std::size_t at(const Index3& leaf) const {
    return static_cast<std::size_t>(linear_index(leaf - box_.lo, box_.extent()));
  }

  Box box_;
  std::vector<std::int32_t> place_;
  std::vector<Index3> leaves_;
  std::vector<float> values_;
};

}  // namespace weir
