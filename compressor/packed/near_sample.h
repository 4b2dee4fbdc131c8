// Of which blocks the survey builds near rungs: enough to tell whether a budget can use them.
#pragma once

#include <algorithm>
#include <cstdint>

namespace weir {

/// Whether it does of a leaf of that linear index: of all of a small volume, of one in 64 of a large one.
inline bool is_near_sample(std::int64_t leaf, std::int64_t leaves) {
  constexpr std::int64_t kEnough = 2048;
  constexpr std::int64_t kMostApart = 64;
  const auto period = static_cast<std::uint64_t>(std::clamp<std::int64_t>(leaves / kEnough, 1, kMostApart));
  constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15U;  // spreads neighbours
  return (static_cast<std::uint64_t>(leaf) * kGolden >> 32U) % period == 0;
}

}  // namespace weir
