// Decoded blocks of 8^3 voxels in a fixed amount of memory that all rendering threads share. It is set-associative
// with four ways, and has no locks. Any thread may read and store at any time.
//
// A slot has 512 floats and one word of state: the block's key plus 1 (0: empty), a flag for a recent read, and a
// sequence number that is odd while a thread writes the slot. A reader looks at the state before and after it reads
// the floats, and uses them only if the state did not change (a sequence lock: Boehm, Can Seqlocks Get Along With
// Programming Language Memory Models?, MSPC 2012). Here floats are loaded with acquire and stored with release, which
// does what the paper's fences do and costs nothing on x86.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>

namespace weir {

class BlockCache {
 public:
  static constexpr std::uint32_t kWays = 4;
  static constexpr std::uint32_t kVoxels = 512;
  /// Bytes of a slot.
  static constexpr std::uint64_t kBlockBytes = kVoxels * sizeof(float) + sizeof(std::uint64_t);

  /// Holds as many blocks as fit into `bytes`, in sets of kWays, at least one set. Memory pages are touched only when
  /// blocks are stored.
  explicit BlockCache(std::uint64_t bytes);

  std::uint64_t blocks() const { return std::uint64_t{sets_} * kWays; }
  std::uint64_t bytes() const { return blocks() * kBlockBytes; }

  /// Reads the values at `offsets`, each below kVoxels, of the block `key`, which is below 2^32 - 1. Returns false if
  /// the block is not in the cache; `values` are then undefined.
  template <std::size_t N>
  bool load(std::uint32_t key, const std::array<std::uint32_t, N>& offsets, float (&values)[N]) const {
    const std::uint64_t first = first_slot(key);
    for (std::uint64_t slot = first; slot < first + kWays; ++slot) {
      const std::uint64_t before = state(slot).load(std::memory_order_acquire);
      if (before >> 32U != std::uint64_t{key} + 1) continue;
      for (std::size_t k = 0; k < N; ++k) values[k] = value(slot, offsets[k]).load(std::memory_order_acquire);
      if (((state(slot).load(std::memory_order_relaxed) ^ before) & ~kUsed) != 0) return false;
      if ((before & kUsed) == 0) state(slot).fetch_or(kUsed, std::memory_order_relaxed);
      return true;
    }
    return false;
  }

  /// Stores the block `key` in an empty slot of its set, or in one that was not read since it was stored or last
  /// passed over. `turn` gives the slot at which the search begins. May leave the block out if other threads write to
  /// the set. Returns true if another block was evicted.
  bool store(std::uint32_t key, std::span<const float, kVoxels> values, std::uint32_t turn);

 private:
  static constexpr std::uint64_t kUsed = std::uint64_t{1} << 31U;
  static constexpr std::uint64_t kSequence = kUsed - 1;

  struct Free {
    void operator()(void* p) const { std::free(p); }
  };

  // Fibonacci hashing, so that neighbouring blocks go to distant sets.
  std::uint64_t first_slot(std::uint32_t key) const {
    const std::uint32_t hash = key * 0x9E3779B9U;
    return (std::uint64_t{hash} * sets_ >> 32U) * kWays;
  }
  std::atomic_ref<std::uint64_t> state(std::uint64_t slot) const { return std::atomic_ref(states_[slot]); }
  std::atomic_ref<float> value(std::uint64_t slot, std::uint32_t offset) const {
    return std::atomic_ref(values_[slot * kVoxels + offset]);
  }
  std::uint64_t choose_slot(std::uint64_t first, std::uint32_t turn);

  std::uint32_t sets_;
  std::unique_ptr<std::uint64_t[], Free> states_;
  std::unique_ptr<float[], Free> values_;
};

}  // namespace weir
