// Where a look-up lies in a page table and in a brick, in fixed point numbers. For host and device.
#pragma once

#include <cstdint>

#include "gpu/cuda/bricks/fixed_point.h"
#include "gpu/cuda/bricks/page_table.h"

namespace weir {

/// For domains of at most kMost voxels along each axis. Finds the same places as BrickTable.
class FixedPositions {
 public:
  static constexpr std::int32_t kMost = static_cast<std::int32_t>(kFixedPointEnd) - 136;

  /// Fixed point numbers, counted from the first region's corner.
  using Position = FixedPlace;

  FixedPositions() = default;
  explicit FixedPositions(const BlockLattice& lattice)
      : across_(static_cast<std::uint32_t>(lattice.regions.x)), down_(static_cast<std::uint32_t>(lattice.regions.y)) {
    constexpr std::uint32_t kFirst = kFixedPointBits >> 15U;
    origin_ = kFirst + across_ * (kFirst + down_ * kFirst);
    const auto from_corner = [](std::int32_t shift) { return kFixedPoint + static_cast<float>(shift); };
    first_ = {from_corner(lattice.shift.x), from_corner(lattice.shift.y), from_corner(lattice.shift.z)};
    last_ = {static_cast<float>(lattice.extent.x - 1), static_cast<float>(lattice.extent.y - 1),
             static_cast<float>(lattice.extent.z - 1)};
  }

  /// Returns the position of local voxel coordinates; voxel centres are at whole numbers. Points outside are moved
  /// into the domain.
  WEIR_HOST_DEVICE Position at(const Float3& q) const { return {q, first_, last_}; }
  WEIR_HOST_DEVICE std::uint32_t region(const Position& at) const {
    return (at.x >> 15U) + across_ * ((at.y >> 15U) + down_ * (at.z >> 15U)) - origin_;
  }
  /// Returns the position of the block in its region.
  WEIR_HOST_DEVICE static std::uint32_t in_region(const Position& at) {
    return (at.x >> 3U & 0xF00U) | (at.y >> 7U & 0xF0U) | (at.z >> 11U & 15U);
  }
  /// Returns the texture coordinates in the brick of the block's entry.
  WEIR_HOST_DEVICE static Float3 texel(const BrickEntry& entry, const Position& at) {
    return entry.texel(at.x, at.y, at.z);
  }

 private:
  std::uint32_t across_ = 0;  // regions along x
  std::uint32_t down_ = 0;    // regions along y
  std::uint32_t origin_ = 0;  // what region() yields for the first region before `origin_` is subtracted
  Float3 first_;              // kFixedPoint + voxels from the first region's corner to the domain's
  Float3 last_;               // the domain's highest voxel
};

}  // namespace weir
