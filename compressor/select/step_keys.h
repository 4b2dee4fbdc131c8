// The order in which a selection buys: the key of everything that can be bought is
// the error that it saves per byte, and what has the higher key is bought first.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "compressor/select/leaf_gain.h"

namespace weir {

/// The key of what is bought whatever the budget.
inline constexpr double kRequiredKey = std::numeric_limits<double>::infinity();
/// Saves nothing that can be measured, but without it not every bit is kept: bought last.
inline constexpr double kLastKey = std::numeric_limits<double>::denorm_min();

/// Keys are not negative, so that their bits sort as they do.
inline std::uint64_t key_bits(double key) { return std::bit_cast<std::uint64_t>(key); }

/// Keys whose bits are in [first, end).
struct KeyRange {
  std::uint64_t first;
  std::uint64_t end;
  bool holds(double key) const { return key_bits(key) - first < end - first; }
  bool holds(const KeyRange& range) const { return first <= range.first && range.end <= end; }
  bool operator==(const KeyRange&) const = default;
};

/// Key of step `i` of a leaf in a region of `region_key`: never above it, and falling from step to step.
double step_key(const LeafGain& leaf, std::uint32_t i, double region_key);

/// Calls visit(key, leaf, step) for the steps of a region's leaves.
template <typename Visit>
void for_each_step(const RegionGains& gains, double region_key, const Visit& visit) {
  for (const LeafGain& leaf : gains) {
    for (std::uint32_t i = 0; i < leaf.step_count; ++i) visit(step_key(leaf, i, region_key), leaf, leaf.steps[i]);
  }
}

/// One step of one leaf.
struct LeafPurchase {
  const LeafGain* leaf;
  std::uint32_t step;
};

/// The steps of a region's leaves whose key is `threshold`, in the order they are bought: the higher own key first,
/// which is a leaf's earlier step too, then whole bricks, then the leaf index.
std::vector<LeafPurchase> tied_steps(const RegionGains& gains, double region_key, double threshold);

}  // namespace weir
