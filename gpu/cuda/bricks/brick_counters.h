// What the work of a brick cache counts on the device. For host and device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"

namespace weir {

struct BrickCounters {
  static constexpr std::uint32_t kAges = 64;

  std::uint32_t brick_requests = 0;   ///< in this turn
  std::uint32_t region_requests = 0;  ///< in this turn
  std::uint32_t evicted = 0;          ///< bricks, in this turn
  std::uint32_t ages[kAges] = {};     ///< slots by turns since their last use; the last count: that many turns or more
  std::uint32_t blocks = 0;           ///< blocks of this batch
  std::uint32_t free_slots = 0;
  std::uint32_t unfit = 0;    ///< bricks whose values 16 bits do not hold
  std::uint32_t worst = 0;    ///< largest span of a brick, as a float's bits
  std::uint64_t built = 0;    ///< bricks built in total
  std::uint64_t decoded = 0;  ///< blocks decoded in total
};

/// Runs before slots are counted.
struct BeginTurn {
  BrickCounters* counters = nullptr;
  WEIR_HOST_DEVICE void operator()(std::uint32_t) const {
    for (std::uint32_t& age : counters->ages) age = 0;
    counters->evicted = 0;
  }
};

/// Runs after all requests are served or forgotten.
struct EndTurn {
  BrickCounters* counters = nullptr;
  WEIR_HOST_DEVICE void operator()(std::uint32_t) const {
    counters->brick_requests = 0;
    counters->region_requests = 0;
  }
};

struct BeginBatch {
  BrickCounters* counters = nullptr;
  WEIR_HOST_DEVICE void operator()(std::uint32_t) const { counters->blocks = 0; }
};

/// Runs after a batch of `bricks`.
struct EndBatch {
  BrickCounters* counters = nullptr;
  std::uint32_t bricks = 0;
  WEIR_HOST_DEVICE void operator()(std::uint32_t) const {
    counters->built += bricks;
    counters->decoded += counters->blocks;
  }
};

}  // namespace weir
