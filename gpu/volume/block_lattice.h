// The blocks of 8^3 voxels over a grid's domain, in regions of 16^3 blocks that begin at multiples of 128 voxels. For
// host and device.
#pragma once

#include <cstdint>

#include "format/base/index.h"
#include "gpu/math/narrow.h"
#include "gpu/math/vector3.h"

namespace weir {

/// Number of blocks per region.
inline constexpr std::uint32_t kRegionBlocks = 4096;
inline constexpr std::int64_t kRegionDim = 128;  ///< voxels

/// A block of a grid: kRegionBlocks * linear index of its region (x fastest) + its position there (packed_position()).
using BlockId = std::uint64_t;

/// Positions of blocks count from the first region's lowest corner.
struct BlockLattice {
  Int3 regions;  ///< along each axis
  Int3 shift;    ///< voxels from the first region's corner to the domain's, in [0, 128)
  Int3 extent;   ///< voxels of the domain

  WEIR_HOST_DEVICE std::uint32_t region_of(const Int3& block) const {
    return table_index({block.x >> 4, block.y >> 4, block.z >> 4}, regions);
  }
  WEIR_HOST_DEVICE static std::uint32_t position_of(const Int3& block) {
    return static_cast<std::uint32_t>((block.x & 15) << 8 | (block.y & 15) << 4 | (block.z & 15));
  }
  WEIR_HOST_DEVICE BlockId id_of(const Int3& block) const {
    return static_cast<BlockId>(region_of(block)) * kRegionBlocks + position_of(block);
  }
  WEIR_HOST_DEVICE Int3 region_at(std::uint32_t region) const {
    const auto nx = static_cast<std::uint32_t>(regions.x);
    const auto ny = static_cast<std::uint32_t>(regions.y);
    return {static_cast<std::int32_t>(region % nx), static_cast<std::int32_t>(region / nx % ny),
            static_cast<std::int32_t>(region / nx / ny)};
  }
  WEIR_HOST_DEVICE Int3 block_at(BlockId id) const {
    const Int3 region = region_at(static_cast<std::uint32_t>(id / kRegionBlocks));
    const auto position = static_cast<std::int32_t>(id % kRegionBlocks);
    return {16 * region.x + (position >> 8), 16 * region.y + (position >> 4 & 15), 16 * region.z + (position & 15)};
  }
  /// Returns the block of the domain's highest voxel.
  WEIR_HOST_DEVICE Int3 last_block() const {
    return {(shift.x + extent.x - 1) >> 3, (shift.y + extent.y - 1) >> 3, (shift.z + extent.z - 1) >> 3};
  }
  /// Returns whether a block has voxels of the domain.
  WEIR_HOST_DEVICE bool contains(const Int3& block) const {
    const Int3 last = last_block();
    return block.x >= shift.x >> 3 && block.y >= shift.y >> 3 && block.z >= shift.z >> 3 && block.x <= last.x &&
           block.y <= last.y && block.z <= last.z;
  }
  /// Returns the k-th of `block` and its seven upper neighbours. A block outside the domain is replaced by the
  /// nearest one inside.
  WEIR_HOST_DEVICE Int3 above(const Int3& block, std::uint32_t k) const {
    const Int3 last = last_block();
    return {lesser(block.x + static_cast<std::int32_t>(k & 1U), last.x),
            lesser(block.y + static_cast<std::int32_t>(k >> 1U & 1U), last.y),
            lesser(block.z + static_cast<std::int32_t>(k >> 2U), last.z)};
  }
  WEIR_HOST_DEVICE std::uint32_t region_count() const {
    return static_cast<std::uint32_t>(regions.x) * static_cast<std::uint32_t>(regions.y) *
           static_cast<std::uint32_t>(regions.z);
  }
};

/// Returns the lattice for a grid's index box, which leaf_lattice() has accepted.
inline BlockLattice block_lattice(const Box& domain) {
  const NodeLattice regions = make_lattice(domain, kRegionDim);
  return {narrow(regions.count), narrow(domain.lo - regions.first * kRegionDim), narrow(domain.extent())};
}

}  // namespace weir
