// Makes bricks from decoded blocks: finds the blocks that they need, and writes their texels. For host and device.
#pragma once

#include <cstdint>

#include "format/nanovdb/macrocells.h"
#include "gpu/cuda/bricks/block_numbers.h"
#include "gpu/cuda/bricks/brick_slots.h"
#include "gpu/cuda/bricks/page_table.h"

namespace weir {

/// Largest code of a texel of 16 bits.
inline constexpr float kMostTexel = 65535;

/// Requests every missing brick of a range of pages. Runs for each of the pages' entries.
struct RequestMissing {
  PageTable table;
  std::uint32_t first_page = 1;
  const std::uint32_t* regions = nullptr;  ///< regions of the pages, from page 1 on

  WEIR_HOST_DEVICE void operator()(std::uint32_t i) const {
    const std::uint32_t page = first_page + i / kRegionBlocks;
    BrickEntry& entry = table.entries[static_cast<std::size_t>(page) * kRegionBlocks + i % kRegionBlocks];
    if ((entry.state & brick_state::kMissing) == 0) return;
    table.requests.note(entry, static_cast<BlockId>(regions[page - 1]) * kRegionBlocks + i % kRegionBlocks);
  }
};

/// Counts the missing entries, of all from page 1 on.
struct CountMissing {
  const BrickEntry* entries = nullptr;
  std::uint32_t* count = nullptr;

  WEIR_HOST_DEVICE void operator()(std::uint32_t i) const {
    if ((entries[std::size_t{kRegionBlocks} + i].state & brick_state::kMissing) != 0) atomic_add(count, 1U);
  }
};

/// Clears the request flags of bricks. Runs for each brick.
struct ForgetRequests {
  PageTable table;
  const BlockId* bricks = nullptr;

  WEIR_HOST_DEVICE void operator()(std::uint32_t i) const {
    const Int3 block = table.lattice.block_at(bricks[i]);
    table.entry(table.regions[table.lattice.region_of(block)].page, block).state &= ~brick_state::kRequested;
  }
};

/// Numbers the blocks that bricks need. Runs eight times for each brick.
struct NumberBlocks {
  BlockLattice lattice;
  const BlockId* bricks = nullptr;
  BlockNumbers numbers;

  WEIR_HOST_DEVICE void operator()(std::uint32_t i) const {
    numbers.add(lattice.id_of(lattice.above(lattice.block_at(bricks[i / 8]), i % 8)));
  }
};

/// One group of threads per brick: finds the brick's range, takes a slot for it if it has more than one value, writes
/// its texels and its entry. `Texels` has kSixteenBits, and write(position, code or value).
template <class Texels>
struct BuildBricks {
  struct Shared {
    std::uint32_t numbers[8];
    MinMax of_warps[32];
    std::uint32_t not_finite;
    BrickEntry made;
  };

  PageTable table;
  BrickSlots slots;
  BrickCounters* counters = nullptr;
  BlockNumbers numbers;
  const float* values = nullptr;  ///< 512 per block, by number
  const BlockId* bricks = nullptr;
  std::uint32_t turn = 0;
  Texels texels;

  template <class Thread>
  WEIR_HOST_DEVICE void operator()(const Thread& thread, Shared& shared, std::uint32_t i) const {
    const Int3 block = table.lattice.block_at(bricks[i]);
    for (std::uint32_t k = thread.index(); k < 8; k += thread.count()) {
      shared.numbers[k] = numbers.of(table.lattice.id_of(table.lattice.above(block, k)));
    }
    if (thread.index() == 0) shared.not_finite = 0;
    thread.meet();
    MinMax range{kInfinity, -kInfinity};
    for (std::int32_t n = first(thread); n < kBrickTexels; n += step(thread)) {
      const float value = texel(shared, block, n);
      if (!is_finite(value)) shared.not_finite = 1;
      range = {lesser(range.min, value), greater(range.max, value)};
    }
    range = thread.widest(range, shared.of_warps);
    if (thread.index() == 0) {
      shared.made = entry_for(range, shared.not_finite == 0);
      table.entry(table.regions[table.lattice.region_of(block)].page, block) = shared.made;
      if (shared.made.brick != 0) own(shared.made, block, 0.5F * range.min + 0.5F * range.max);
    }
    thread.meet();
    const BrickEntry made = shared.made;
    if (made.brick != 0) {
      const Int3 corner = made.corner();
      for (std::int32_t n = first(thread); n < kBrickTexels; n += step(thread)) {
        write({corner.x + n / (kBrickEdge * kBrickEdge), corner.y + n / kBrickEdge % kBrickEdge,
               corner.z + n % kBrickEdge},
              texel(shared, block, n), made);
      }
    }
    thread.meet();
  }

 private:
  template <class Thread>
  WEIR_HOST_DEVICE static std::int32_t first(const Thread& thread) {
    return static_cast<std::int32_t>(thread.index());
  }
  template <class Thread>
  WEIR_HOST_DEVICE static std::int32_t step(const Thread& thread) {
    return static_cast<std::int32_t>(thread.count());
  }

  // Returns the n-th voxel of a brick, z fastest as in blocks. For a voxel outside the domain, returns the nearest
  // voxel inside.
  WEIR_HOST_DEVICE float texel(const Shared& shared, const Int3& block, std::int32_t n) const {
    const BlockLattice& l = table.lattice;
    const Int3 v{clamped(8 * block.x + n / (kBrickEdge * kBrickEdge), l.shift.x, l.shift.x + l.extent.x - 1),
                 clamped(8 * block.y + n / kBrickEdge % kBrickEdge, l.shift.y, l.shift.y + l.extent.y - 1),
                 clamped(8 * block.z + n % kBrickEdge, l.shift.z, l.shift.z + l.extent.z - 1)};
    const std::int32_t k = ((v.x >> 3) - block.x) | ((v.y >> 3) - block.y) << 1 | ((v.z >> 3) - block.z) << 2;
    return values[std::size_t{512} * shared.numbers[k] +
                  static_cast<std::size_t>((v.x & 7) << 6 | (v.y & 7) << 3 | (v.z & 7))];
  }

  // Makes the brick's entry. Takes a slot if the brick needs one.
  WEIR_HOST_DEVICE BrickEntry entry_for(const MinMax& range, bool finite) const {
    if (finite && range.min == range.max) return {range.min, 0, 0, 0};
    BrickEntry entry{0, 1, 0, 0};
    if constexpr (Texels::kSixteenBits) {
      entry.low = range.min;
      entry.span = range.max - range.min;
      if (!finite || !is_finite(entry.span) || !is_finite(kMostTexel / entry.span)) {
        atomic_add(&counters->unfit, 1U);
        return {0, 0, 0, brick_state::kMissing};  // missing, so that another turn comes and sees the count
      }
      std::uint32_t bits;
      __builtin_memcpy(&bits, &entry.span, sizeof bits);
      atomic_max(&counters->worst, bits);  // positive floats have the order of their bits
    }
    entry.brick = slots.brick(slots.free[atomic_add(&counters->free_slots, ~0U) - 1]);
    return entry;
  }

  WEIR_HOST_DEVICE void own(const BrickEntry& made, const Int3& block, float middle) const {
    const std::uint32_t slot = slots.slot(made.brick);
    const std::uint32_t page = table.regions[table.lattice.region_of(block)].page;
    slots.owners[slot] = page * kRegionBlocks + BlockLattice::position_of(block);
    slots.stamps[slot] = turn;
    slots.middles[slot] = is_finite(middle) ? middle : 0;
  }

  WEIR_HOST_DEVICE void write(const Int3& at, float value, const BrickEntry& made) const {
    if constexpr (Texels::kSixteenBits) {
      const float code = (value - made.low) * (kMostTexel / made.span) + 0.5F;
      texels.write(at, static_cast<std::uint16_t>(lesser(code, kMostTexel)));
    } else {
      texels.write(at, value);
    }
  }
};

}  // namespace weir
