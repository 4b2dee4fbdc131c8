// The block of a look-up and the place in the block's brick. The same place as BrickTable's, but in domains of any
// size. For host and device.
#pragma once

#include <cstdint>

#include "gpu/cuda/bricks/fixed_point.h"
#include "gpu/cuda/bricks/page_table.h"

namespace weir {

struct BrickPosition {
  Int3 block;
  Float3 in_block;  ///< voxels from the centre of the block's lowest voxel

  /// `q` are local voxel coordinates with centres at whole numbers. Points outside are moved into the domain.
  WEIR_HOST_DEVICE BrickPosition(const BlockLattice& lattice, const Float3& q) {
    in_block.x = place(q.x, lattice.extent.x, lattice.shift.x, block.x);
    in_block.y = place(q.y, lattice.extent.y, lattice.shift.y, block.y);
    in_block.z = place(q.z, lattice.extent.z, lattice.shift.z, block.z);
  }

  /// Returns the texture coordinates in the brick of the block's entry.
  WEIR_HOST_DEVICE Float3 texel(const BrickEntry& entry) const {
    const Int3 corner = entry.corner();
    return {static_cast<float>(corner.x) + in_block.x + 0.5F, static_cast<float>(corner.y) + in_block.y + 0.5F,
            static_cast<float>(corner.z) + in_block.z + 0.5F};
  }

 private:
  // Rounds to as many bits as the texture unit uses, so that the result does not depend on where a brick lies.
  WEIR_HOST_DEVICE static float place(float q, std::int32_t extent, std::int32_t shift, std::int32_t& block) {
    const float first = static_cast<float>(shift & 7) + kFixedPoint;
    const float rounded = clamped(q, 0.0F, static_cast<float>(extent - 1)) + first - kFixedPoint;
    // Floats above 2^24 may lie beyond the last voxel, or outside the block.
    constexpr float kMost = 8 - 1.0F / 256;
    const std::int32_t b = lesser(static_cast<std::int32_t>(rounded) >> 3, ((shift & 7) + extent - 1) >> 3);
    block = b + (shift >> 3);
    return lesser(rounded - static_cast<float>(8 * b), kMost);
  }
};

/// Does for domains of any size what FixedPositions does for smaller ones.
class WidePositions {
 public:
  using Position = BrickPosition;

  WidePositions() = default;
  explicit WidePositions(const BlockLattice& lattice) : lattice_(lattice) {}

  WEIR_HOST_DEVICE Position at(const Float3& q) const { return {lattice_, q}; }
  WEIR_HOST_DEVICE std::uint32_t region(const Position& at) const { return lattice_.region_of(at.block); }
  WEIR_HOST_DEVICE static std::uint32_t in_region(const Position& at) { return BlockLattice::position_of(at.block); }
  WEIR_HOST_DEVICE static Float3 texel(const BrickEntry& entry, const Position& at) { return at.texel(entry); }

 private:
  BlockLattice lattice_;
};

}  // namespace weir
