// Where the bricks of a grid are if all of them are on the device: one entry per block. For host and device.
#pragma once

#include <cstdint>

#include "gpu/cuda/bricks/fixed_point.h"
#include "gpu/cuda/bricks/page_table.h"

namespace weir {

struct BrickTable {
  const BrickEntry* entries = nullptr;  ///< of the domain's blocks, x fastest
  std::uint32_t across = 1;             ///< blocks along x
  std::uint32_t down = 1;               ///< blocks along y
  std::uint32_t origin = 0;             ///< what index() yields for the first block before `origin` is subtracted
  Float3 first;                         ///< kFixedPoint + voxels from the first block's corner to the domain's
  Float3 last;                          ///< the domain's highest voxel

  /// Fixed point numbers, counted from the first block's corner.
  using Position = FixedPlace;

  BrickTable() = default;
  /// The domain has at most kFixedPointEnd - 8 voxels along each axis.
  BrickTable(const BlockLattice& lattice, const BrickEntry* all)
      : entries(all),
        across(static_cast<std::uint32_t>(blocks(lattice).x)),
        down(static_cast<std::uint32_t>(blocks(lattice).y)) {
    constexpr std::uint32_t kFirst = kFixedPointBits >> 11U;
    origin = kFirst + across * (kFirst + down * kFirst);
    const auto from_corner = [](std::int32_t shift) { return kFixedPoint + static_cast<float>(shift & 7); };
    first = {from_corner(lattice.shift.x), from_corner(lattice.shift.y), from_corner(lattice.shift.z)};
    last = {static_cast<float>(lattice.extent.x - 1), static_cast<float>(lattice.extent.y - 1),
            static_cast<float>(lattice.extent.z - 1)};
  }

  /// Returns the number of blocks along each axis of the table over a lattice.
  WEIR_HOST_DEVICE static Int3 blocks(const BlockLattice& lattice) {
    const Int3 last = lattice.last_block();
    return {last.x - (lattice.shift.x >> 3) + 1, last.y - (lattice.shift.y >> 3) + 1,
            last.z - (lattice.shift.z >> 3) + 1};
  }

  /// Returns the position of local voxel coordinates; voxel centres are at whole numbers. Points outside are moved
  /// into the domain.
  WEIR_HOST_DEVICE Position position(const Float3& q) const { return {q, first, last}; }
  WEIR_HOST_DEVICE std::uint32_t index(const Position& at) const {
    return (at.x >> 11U) + across * ((at.y >> 11U) + down * (at.z >> 11U)) - origin;
  }
  /// Returns the entry of the position's block.
  WEIR_HOST_DEVICE BrickEntry entry(const Position& at) const { return entries[index(at)]; }
  WEIR_HOST_DEVICE static Float3 texel(const BrickEntry& entry, const Position& at) {
    return entry.texel(at.x, at.y, at.z);
  }
};

/// Fills a table from pages that are all on the device. Runs for each of the table's entries.
struct FillBrickTable {
  PageTable pages;
  BrickEntry* entries = nullptr;

  WEIR_HOST_DEVICE void operator()(std::uint32_t i) const {
    const BlockLattice& l = pages.lattice;
    const Int3 count = BrickTable::blocks(l);
    const auto at = static_cast<std::int32_t>(i);
    entries[i] = pages.find({at % count.x + (l.shift.x >> 3), at / count.x % count.y + (l.shift.y >> 3),
                             at / count.x / count.y + (l.shift.z >> 3)});
  }
};

}  // namespace weir
