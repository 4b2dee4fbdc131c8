// Leaves with values that lie in memory already: a block of them need not be read.
#pragma once

#include <array>
#include <span>

#include "format/base/index.h"

namespace weir {

/// Thread-safe.
class HeldLeaves {
 public:
  virtual ~HeldLeaves() = default;

  /// Returns the values of the leaf with the in-domain voxels `inside`, x fastest. The function may put them into
  /// `room`. They stay valid as long as this object and `room`.
  virtual std::span<const float> leaf(const Box& inside, std::array<float, kLeafVoxels>& room) const = 0;
};

}  // namespace weir
