// Leaves whose values lie in memory: a block of them is not read.
#pragma once

#include <array>
#include <span>

#include "format/base/index.h"

namespace weir {

/// Thread-safe.
class HeldLeaves {
 public:
  virtual ~HeldLeaves() = default;

  /// The values of the leaf whose voxels in the domain are `inside`, x fastest. They stay as long as the object and
  /// `room`, where they may be put.
  virtual std::span<const float> leaf(const Box& inside, std::array<float, kLeafVoxels>& room) const = 0;
};

}  // namespace weir
