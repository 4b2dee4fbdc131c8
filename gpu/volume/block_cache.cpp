#include "gpu/volume/block_cache.h"

#include <algorithm>
#include <limits>
#include <new>

namespace weir {

namespace {

constexpr std::size_t kCacheLine = 64;

std::uint32_t sets_of(std::uint64_t bytes) {
  const std::uint64_t sets = bytes / (BlockCache::kWays * BlockCache::kBlockBytes);
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(sets, 1, std::numeric_limits<std::uint32_t>::max()));
}

}  // namespace

BlockCache::BlockCache(std::uint64_t bytes)
    : sets_(sets_of(bytes)),
      states_(static_cast<std::uint64_t*>(std::calloc(blocks(), sizeof(std::uint64_t)))),
      values_(static_cast<float*>(std::aligned_alloc(kCacheLine, blocks() * kVoxels * sizeof(float)))) {
  if (!states_ || !values_) throw std::bad_alloc();
}

bool BlockCache::store(std::uint32_t key, std::span<const float, kVoxels> values, std::uint32_t turn) {
  const std::uint64_t first = first_slot(key);
  for (std::uint64_t slot = first; slot < first + kWays; ++slot) {
    // Another thread was faster.
    if (state(slot).load(std::memory_order_relaxed) >> 32U == std::uint64_t{key} + 1) return false;
  }
  const std::uint64_t slot = choose_slot(first, turn);
  std::uint64_t before = state(slot).load(std::memory_order_relaxed);
  const std::uint64_t sequence = before & kSequence;
  if (sequence % 2 != 0) return false;
  if (!state(slot).compare_exchange_strong(before, sequence + 1, std::memory_order_acquire,
                                           std::memory_order_relaxed)) {
    return false;
  }
  for (std::uint32_t i = 0; i < kVoxels; ++i) value(slot, i).store(values[i], std::memory_order_release);
  state(slot).store((std::uint64_t{key} + 1) << 32U | ((sequence + 2) & kSequence), std::memory_order_release);
  return before >> 32U != 0;
}

// Second chance: a slot that was read since the last pass is passed over once more.
std::uint64_t BlockCache::choose_slot(std::uint64_t first, std::uint32_t turn) {
  for (std::uint64_t slot = first; slot < first + kWays; ++slot) {
    if (state(slot).load(std::memory_order_relaxed) == 0) return slot;
  }
  for (std::uint32_t i = 0; i < kWays; ++i) {
    const std::uint64_t slot = first + (turn + i) % kWays;
    if ((state(slot).load(std::memory_order_relaxed) & kUsed) == 0) return slot;
    state(slot).fetch_and(~kUsed, std::memory_order_relaxed);
  }
  return first + turn % kWays;
}

}  // namespace weir
