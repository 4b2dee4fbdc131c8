// The order in which a selection buys. The key of a purchase is the error that it saves per byte. Higher keys are
// bought first.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "compressor/select/leaf_gain.h"

namespace weir {

/// The key of a purchase that every budget requires.
inline constexpr double kRequiredKey = std::numeric_limits<double>::infinity();
/// The key of a step that saves no measurable error but is needed to keep every bit: bought last.
inline constexpr double kLastKey = std::numeric_limits<double>::denorm_min();

/// Returns the bits of `key`. Keys are not negative, so their bits sort in the same order.
inline std::uint64_t key_bits(double key) { return std::bit_cast<std::uint64_t>(key); }

/// The keys with bits in [first, end).
struct KeyRange {
  std::uint64_t first;
  std::uint64_t end;
  bool holds(double key) const { return key_bits(key) - first < end - first; }
  bool holds(const KeyRange& range) const { return first <= range.first && range.end <= end; }
  bool operator==(const KeyRange&) const = default;
};

/// Returns the key of step `i` of a leaf in a region with key `region_key`. Keys fall from step to step and are never
/// above `region_key`, except a required first step, which has kRequiredKey.
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

/// Returns the steps of a region's leaves with the key `threshold`, in the order in which they are bought: first the
/// step with the higher own key (of one leaf, the earlier step), then whole bricks, then by leaf index.
std::vector<LeafPurchase> tied_steps(const RegionGains& gains, double region_key, double threshold);

}  // namespace weir
