// A box cut into smaller ones along a grid's edges. Pure arithmetic.
#pragma once

#include <cstdint>

#include "format/base/index.h"

namespace weir {

/// The parts of `box` between planes of the grid of `unit` voxels with a corner at `corner`: as many whole
/// units together as `voxels` hold, along x first, then y, then z; one where even that is more.
class BoxCuts {
 public:
  /// unit >= 1 along each axis; `box` is not empty.
  BoxCuts(const Box& box, const Index3& unit, const Index3& corner, std::int64_t voxels);

  std::int64_t size() const { return volume(count_); }
  /// Voxels of the largest part.
  std::int64_t most_voxels() const { return volume(min(part_, box_.extent())); }
  /// x fastest, then y, then z; never empty.
  Box part(std::int64_t i) const;

 private:
  Box box_;
  Index3 part_;   ///< voxels
  Index3 first_;  ///< corner of the first part, at or before box_.lo
  Index3 count_;
};

}  // namespace weir
