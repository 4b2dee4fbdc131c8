// The places for bricks on a device, and the steps that assign and free them. For host and device.
#pragma once

#include <cstdint>

#include "gpu/cuda/bricks/brick_counters.h"
#include "gpu/cuda/bricks/page_table.h"

namespace weir {

struct BrickSlots {
  static constexpr std::uint32_t kFree = ~0U;

  std::uint32_t* owners = nullptr;  ///< numbers of the slots' entries in the page table, or kFree
  std::uint32_t* stamps = nullptr;  ///< turns of the slots' last use
  std::uint32_t* free = nullptr;    ///< numbers of the counters->free_slots free slots
  float* middles = nullptr;         ///< middles of the ranges of their bricks' values
  std::uint32_t count = 0;
  std::uint32_t across = 0;  ///< bricks along x of the texture
  std::uint32_t down = 0;    ///< bricks along y

  /// Returns the slot's place as BrickEntry::brick stores it. Place (0, 0, 0) stays unused.
  WEIR_HOST_DEVICE std::uint32_t brick(std::uint32_t slot) const {
    const std::uint32_t n = slot + 1;
    return BrickEntry::pack(n % across, n / across % down, n / across / down);
  }
  /// Returns the turns since the slot's last use, limited as BrickCounters counts them.
  WEIR_HOST_DEVICE std::uint32_t age(std::uint32_t slot, std::uint32_t turn) const {
    return lesser(turn - stamps[slot], BrickCounters::kAges - 1);
  }
  /// Returns the slot of a place that brick() returned.
  WEIR_HOST_DEVICE std::uint32_t slot(std::uint32_t brick) const {
    return (brick & 2047U) + across * ((brick >> 11U & 2047U) + down * (brick >> 22U)) - 1;
  }
};

/// Frees every slot at the beginning. Runs for each slot.
struct FreeAllSlots {
  BrickSlots slots;
  WEIR_HOST_DEVICE void operator()(std::uint32_t i) const {
    slots.owners[i] = BrickSlots::kFree;
    slots.stamps[i] = 0;
    slots.free[i] = slots.count - 1 - i;
  }
};

/// Stamps the slots that were used since the last call, and their pages, and counts all slots by age. Each group of
/// threads takes every `groups`-th stretch of slots.
struct AgeSlots {
  struct Shared {
    std::uint32_t ages[BrickCounters::kAges];
  };

  BrickSlots slots;
  BrickEntry* entries = nullptr;
  std::uint32_t* page_stamps = nullptr;
  BrickCounters* counters = nullptr;
  std::uint32_t turn = 0;
  std::uint32_t groups = 1;

  template <class Thread>
  WEIR_HOST_DEVICE void operator()(const Thread& thread, Shared& shared, std::uint32_t group) const {
    for (std::uint32_t a = thread.index(); a < BrickCounters::kAges; a += thread.count()) shared.ages[a] = 0;
    thread.meet();
    for (std::uint32_t i = group * thread.count() + thread.index(); i < slots.count; i += groups * thread.count()) {
      if (slots.owners[i] == BrickSlots::kFree) continue;
      std::uint32_t& state = entries[slots.owners[i]].state;
      if ((state & brick_state::kUsed) != 0) {
        state &= ~brick_state::kUsed;
        slots.stamps[i] = turn;
        page_stamps[slots.owners[i] / kRegionBlocks] = turn;
      }
      atomic_add(shared.ages + slots.age(i, turn), 1U);
    }
    thread.meet();
    for (std::uint32_t a = thread.index(); a < BrickCounters::kAges; a += thread.count()) {
      if (shared.ages[a] != 0) atomic_add(counters->ages + a, shared.ages[a]);
    }
  }
};

/// Frees `wanted` slots of bricks that are at least `least_age` old.
struct EvictSlots {
  BrickSlots slots;
  BrickEntry* entries = nullptr;
  BrickCounters* counters = nullptr;
  std::uint32_t turn = 0;
  std::uint32_t least_age = 1;
  std::uint32_t wanted = 0;

  WEIR_HOST_DEVICE void operator()(std::uint32_t i) const {
    if (slots.owners[i] == BrickSlots::kFree || slots.age(i, turn) < least_age) return;
    if (atomic_add(&counters->evicted, 1U) >= wanted) return;
    BrickEntry& entry = entries[slots.owners[i]];
    entry = {slots.middles[i], 0, 0, brick_state::kMissing};
    slots.owners[i] = BrickSlots::kFree;
    slots.free[atomic_add(&counters->free_slots, 1U)] = i;
  }
};

/// Takes pages back from regions, and frees the slots of their bricks. Runs for each entry of each page.
struct DropPages {
  PageTable table;
  BrickSlots slots;
  BrickCounters* counters = nullptr;
  std::uint32_t turn = 0;
  const std::uint32_t* regions = nullptr;
  const std::uint32_t* pages = nullptr;

  WEIR_HOST_DEVICE void operator()(std::uint32_t i) const {
    const std::uint32_t n = i / kRegionBlocks;
    BrickEntry& entry = table.entries[static_cast<std::size_t>(pages[n]) * kRegionBlocks + i % kRegionBlocks];
    if (entry.brick != 0) {
      const std::uint32_t slot = slots.slot(entry.brick);
      atomic_add(counters->ages + slots.age(slot, turn), ~0U);  // free, no longer counted by age
      slots.owners[slot] = BrickSlots::kFree;
      slots.free[atomic_add(&counters->free_slots, 1U)] = slot;
    }
    entry = {};
    if (i % kRegionBlocks == 0) table.regions[regions[n]].page = RegionEntry::kMissing;
  }
};

}  // namespace weir
