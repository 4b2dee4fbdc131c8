// Numbers blocks in the order in which they come, each block once: a hash table with open addressing. For host and
// device.
#pragma once

#include <cstdint>

#include "gpu/cuda/bricks/atomics.h"
#include "gpu/volume/block_lattice.h"

namespace weir {

struct BlockNumbers {
  std::uint64_t* keys = nullptr;     ///< id + 1; 0: empty. There are `mask` + 1 keys; half of them stay empty
  std::uint32_t* numbers = nullptr;  ///< of the keys
  std::uint32_t mask = 0;
  BlockId* blocks = nullptr;       ///< blocks by number
  std::uint32_t* count = nullptr;  ///< number of blocks

  WEIR_HOST_DEVICE void add(BlockId id) const {
    for (std::uint32_t at = first(id);; at = (at + 1) & mask) {
      const std::uint64_t before = atomic_replace(keys + at, 0, id + 1);
      if (before == id + 1) return;
      if (before != 0) continue;
      const std::uint32_t n = atomic_add(count, 1U);
      blocks[n] = id;
      numbers[at] = n;
      return;
    }
  }
  /// Returns the number of a block that completed work has added.
  WEIR_HOST_DEVICE std::uint32_t of(BlockId id) const {
    std::uint32_t at = first(id);
    while (keys[at] != id + 1) at = (at + 1) & mask;
    return numbers[at];
  }

 private:
  // Fibonacci hashing.
  WEIR_HOST_DEVICE std::uint32_t first(BlockId id) const {
    return static_cast<std::uint32_t>(id * 0x9E3779B97F4A7C15ULL >> 32U) & mask;
  }
};

}  // namespace weir
