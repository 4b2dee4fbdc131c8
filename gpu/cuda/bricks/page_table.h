// Which blocks of a grid are on the device as bricks, and where: a table of two levels. A region's entry names its
// page, and a page has an entry for each of the region's blocks. If a page or a brick is missing, a look-up notes
// this and continues with an approximate value. For host and device.
#pragma once

#include <cstdint>

#include "gpu/cuda/bricks/atomics.h"
#include "gpu/cuda/bricks/fixed_point.h"
#include "gpu/volume/block_lattice.h"

namespace weir {

/// Voxels along a brick's edge: the 8 of a block and the next voxel above it. So every 2 x 2 x 2 neighbourhood that
/// begins in the block lies in its brick.
inline constexpr std::int32_t kBrickEdge = 9;
inline constexpr std::int32_t kBrickTexels = kBrickEdge * kBrickEdge * kBrickEdge;

namespace brick_state {
inline constexpr std::uint32_t kMissing = 1;    ///< not on the device; the entry's value is an approximation
inline constexpr std::uint32_t kRequested = 2;  ///< requested since requests were last served
inline constexpr std::uint32_t kUsed = 4;       ///< looked up since the flag was last read
}  // namespace brick_state

/// Returns whether both are equal or both are NaN.
WEIR_HOST_DEVICE inline bool same_value(float a, float b) { return a == b || (a != a && b != b); }

/// The entry of a block. Its values are `low` everywhere if it has no brick, otherwise low + span * texel.
struct alignas(16) BrickEntry {
  float low = 0;
  float span = 0;
  std::uint32_t brick = 0;  ///< position of the brick in units of bricks, 11 bits for x and y, 10 for z; 0: none
  std::uint32_t state = 0;

  /// Returns texture coordinates of a place in the brick. `x`, `y` and `z` are fixed point bits of voxels from the
  /// brick's lowest corner; only the last 11 bits count. A voxel's centre lies half a texel above its coordinate.
  WEIR_HOST_DEVICE Float3 texel(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
    return {texel_along(brick & 2047U, x), texel_along(brick >> 11U & 2047U, y), texel_along(brick >> 22U, z)};
  }
  WEIR_HOST_DEVICE static std::uint32_t pack(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    return x | y << 11U | z << 22U;
  }
  /// Returns the texel of the brick's lowest voxel.
  WEIR_HOST_DEVICE Int3 corner() const {
    return {static_cast<std::int32_t>(brick & 2047U) * kBrickEdge,
            static_cast<std::int32_t>(brick >> 11U & 2047U) * kBrickEdge,
            static_cast<std::int32_t>(brick >> 22U) * kBrickEdge};
  }

 private:
  WEIR_HOST_DEVICE static float texel_along(std::uint32_t position, std::uint32_t at) {
    const std::uint32_t bits = position * (256U * kBrickEdge) + (kFixedPointBits | (at & 2047U));
    float v;
    __builtin_memcpy(&v, &bits, sizeof v);
    return v - (kFixedPoint - 0.5F);
  }
};

/// The entry of a region, which has a page or one value everywhere.
struct alignas(8) RegionEntry {
  std::uint32_t page = 0;  ///< page number, from 1, and the flags below; 0: `value` everywhere
  float value = 0;

  static constexpr std::uint32_t kMissing = 1U << 31U;    ///< no page on the device; `value` is approximate
  static constexpr std::uint32_t kRequested = 1U << 30U;  ///< like brick_state::kRequested
};

/// What look-ups did not find, each item once. A full list stays full until it is served; until then nothing more is
/// marked.
struct BrickRequests {
  BlockId* bricks = nullptr;
  std::uint32_t* regions = nullptr;
  std::uint32_t* brick_count = nullptr;   ///< may count beyond most_bricks
  std::uint32_t* region_count = nullptr;  ///< may count beyond most_regions
  std::uint32_t most_bricks = 0;
  std::uint32_t most_regions = 0;

  /// Notes that a brick is missing.
  WEIR_HOST_DEVICE void note(BrickEntry& at, BlockId id) const {
    // Most threads that find the brick missing see here that another thread was first.
    if ((load_fresh(&at.state) & brick_state::kRequested) != 0 || load_fresh(brick_count) >= most_bricks) return;
    if ((atomic_or(&at.state, brick_state::kRequested) & brick_state::kRequested) != 0) return;
    const std::uint32_t n = atomic_add(brick_count, 1U);
    if (n < most_bricks) {
      bricks[n] = id;
    } else {
      atomic_and(&at.state, ~brick_state::kRequested);
    }
  }
  /// Notes that a region's page is missing.
  WEIR_HOST_DEVICE void note(RegionEntry& at, std::uint32_t number) const {
    if ((load_fresh(&at.page) & RegionEntry::kRequested) != 0 || load_fresh(region_count) >= most_regions) return;
    if ((atomic_or(&at.page, RegionEntry::kRequested) & RegionEntry::kRequested) != 0) return;
    const std::uint32_t n = atomic_add(region_count, 1U);
    if (n < most_regions) {
      regions[n] = number;
    } else {
      atomic_and(&at.page, ~RegionEntry::kRequested);
    }
  }
};

/// How a look-up notes a miss: inline, or by calling a function, which leaves the look-up more registers. Paths have
/// few registers, so a call is faster for them (5.3 against 7.9 ms per frame of a cloud on an H100). For marched rays
/// it is slower (11.4 against 8.6 ms).
enum class Noting { inlined, called };

template <class Entry, class Number>
WEIR_HOST_DEVICE WEIR_NO_INLINE void call_note(const BrickRequests& requests, Entry& at, Number number) {
  requests.note(at, number);
}
template <Noting kNoting, class Entry, class Number>
WEIR_HOST_DEVICE void note(const BrickRequests& requests, Entry& at, Number number) {
  if constexpr (kNoting == Noting::called) {
    call_note(requests, at, number);
  } else {
    requests.note(at, number);
  }
}

struct PageTable {
  BlockLattice lattice;
  RegionEntry* regions = nullptr;
  BrickEntry* entries = nullptr;  ///< kRegionBlocks per page; those of page 0 are not used
  BrickRequests requests;

  WEIR_HOST_DEVICE BrickEntry& entry(std::uint32_t page, const Int3& block) const {
    return entries[static_cast<std::size_t>(page) * kRegionBlocks + BlockLattice::position_of(block)];
  }

  /// Returns the entry of a block whose page is on the device.
  WEIR_HOST_DEVICE BrickEntry find(const Int3& block) const {
    return entry(regions[lattice.region_of(block)].page, block);
  }

  /// Returns the entry of any block, given its region and its position_of() there, or an approximation. Notes what is
  /// used and what is missing.
  template <Noting kNoting>
  WEIR_HOST_DEVICE BrickEntry find_or_request(std::uint32_t number, std::uint32_t position) const {
    using namespace brick_state;
    const RegionEntry region = regions[number];
    if ((region.page & RegionEntry::kMissing) != 0) {
      if ((region.page & RegionEntry::kRequested) == 0) note<kNoting>(requests, regions[number], number);
      return {region.value, 0, 0, kMissing};
    }
    if (region.page == 0) return {region.value, 0, 0, 0};
    BrickEntry& at = entries[static_cast<std::size_t>(region.page) * kRegionBlocks + position];
    const BrickEntry found = at;
    if ((found.state & kMissing) != 0) {
      if ((found.state & kRequested) == 0)
        note<kNoting>(requests, at, static_cast<BlockId>(number) * kRegionBlocks + position);
    } else if ((found.state & kUsed) == 0) {
      // This store needs no atomic operation: nothing else changes the state during a picture, and nearby threads see
      // it in their cache.
      store(&at.state, kUsed);
    }
    return found;
  }
  WEIR_HOST_DEVICE BrickEntry find_or_request(const Int3& block) const {
    return find_or_request<Noting::inlined>(lattice.region_of(block), BlockLattice::position_of(block));
  }
};

}  // namespace weir
