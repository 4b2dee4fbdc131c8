// Which rungs of a ladder a budget can choose among, once it is known about where its cut lies. The survey then builds
// three to five of some twenty. What is chosen is the same: at a cut within the window, the best of all rungs is among
// them, as long as each further byte of a block saves less error than the one before.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "compressor/leaf/leaf_row.h"
#include "compressor/packed/packed_ladder.h"
#include "format/packed/block_coder.h"
#include "format/packed/block_steps.h"

namespace weir {

/// Keys between which the cut of a selection lies: squared error saved per byte.
class KeyWindow {
 public:
  /// A sample of the blocks tells the cut within that factor, nearly always.
  static constexpr double kMostReach = 2.5;

  /// From `centre`, a normal number, > 0, divided by `reach`, > 1, to `centre` times that. Values of the volume lie in
  /// a range of about `width`.
  KeyWindow(double centre, float width, double reach = kMostReach)
      : centre_(centre), reach_(reach), width_(width), step_(coarsest_step_within(quantum())) {}
  /// About a key; none about one so small that nothing is left to save.
  static std::optional<KeyWindow> about(double key, float width, double reach = kMostReach) {
    return key >= std::numeric_limits<double>::min() ? std::optional(KeyWindow(key, width, reach)) : std::nullopt;
  }

  double centre() const { return centre_; }
  double reach() const { return reach_; }
  float width() const { return width_; }
  double low() const { return centre_ / reach_; }
  double high() const { return centre_ * reach_; }
  bool holds(double key) const { return key >= low() && key <= high(); }
  /// Of a quantiser whose uniform error falls by that much per byte: at size^2 / 12 a value, halving the step takes a
  /// bit a value, and saves size^2 / 2 a byte.
  double quantum() const { return std::sqrt(2 * centre_); }
  /// The coarsest step whose size is at most that, or the finest.
  std::int32_t step() const { return step_; }
  /// The exponent of the quantum.
  int exponent() const { return exponent_; }
  /// Whether means have codes at the steps that the cut may choose, in each region: a ladder's rungs without one are of
  /// no use.
  bool means_have_codes() const {
    constexpr std::int32_t kOctave = 2;
    return step_ + kOctave <= kMostStep && mean_bits({0, width_}, step_ + kOctave) != kNoMeanBits;
  }
  /// For a coder.
  SearchKeys keys() const { return {low(), high(), means_have_codes()}; }

 private:
  double centre_;
  double reach_;
  float width_;
  std::int32_t step_;
  int exponent_ = std::ilogb(quantum());
};

/// Rungs [first, end), which are next to each other; none where first == end.
struct RungRange {
  std::size_t first = 0;
  std::size_t end = 0;
  bool more = true;  ///< a finer way to keep the block may be chosen, too
  bool has(std::size_t rung) const { return rung >= first && rung < end; }
};

/// Of rungs [first, end), from coarse to fine, those that the window may choose; `start` is about in its middle, and
/// `energy` what a block without a rung loses. at(rung) is its point, or nullopt where there is none; it is asked only
/// for rungs that it takes to tell. The answer is the same whether further rungs have points or not.
template <typename At>
RungRange rungs_within(const KeyWindow& window, double energy, std::size_t start, std::size_t first, std::size_t end,
                       const At& at) {
  if (first >= end) return {first, first, true};
  std::size_t coarse = std::min(std::max(start, first), end - 1);
  std::optional<RungPoint> point = at(coarse);
  while (!point && coarse > first) point = at(--coarse);
  if (!point) return {first, first, true};
  // Costs are in whole bytes: a rung ends the search only where it costs a byte more, at the window's key, than the
  // best one so far.
  const auto cost = [&](const RungPoint& rung, double key) { return energy * rung.share + key * rung.bytes; };
  const double low = window.low();
  const double high = window.high();
  std::size_t fine = coarse;
  bool more = true;
  double best = cost(*point, low);
  while (more && fine + 1 < end) {
    const std::optional<RungPoint> next = at(fine + 1);
    if (!next) break;
    ++fine;
    const double here = cost(*next, low);
    more = here <= best + low;
    best = std::min(best, here);
  }
  constexpr RungPoint kMeanAlone{1, 1};
  best = cost(*point, high);
  while (coarse > first) {
    const std::optional<RungPoint> next = at(coarse - 1);
    if (!next) break;
    --coarse;
    const double here = cost(*next, high);
    if (here > best + high && here < cost(kMeanAlone, high) - high) break;
    best = std::min(best, here);
  }
  return {coarse, fine + 1, more};
}

/// Of a ladder's rungs, those of a window; the mean alone, at rungs 0 and 1, is always kept. The ladder may have been
/// built with that window, or without one.
struct LadderRange {
  RungRange rungs;
  RungRange near;
  bool more = true;  ///< a finer way to keep the block than any of these may be chosen, too
};
LadderRange range_within(const KeyWindow& window, const PackedLadder& ladder, const LeafRow& row);

/// Rungs to search with rungs_within().
template <typename At>
struct RungSearch {
  std::size_t start;
  std::size_t first;
  std::size_t end;
  const At& at;

  /// The point that the search begins at; nullopt where there is none.
  std::optional<RungPoint> point() const {
    if (first >= end) return std::nullopt;
    return at(std::min(std::max(start, first), end - 1));
  }
  RungRange none() const { return {first, first, true}; }
};
template <typename At>
RungSearch(std::size_t, std::size_t, std::size_t, const At&) -> RungSearch<At>;

/// Whether, at every key of the window, `ahead` is so much the better buy than `behind` that the rungs next to `behind`
/// are not chosen, either: they are at most about a bit a value better than the one that a search begins at.
inline bool is_far_ahead(const KeyWindow& window, double energy, const RungPoint& ahead, const RungPoint& behind) {
  constexpr double kBitAValue = kLeafVoxels / 8.0;  // bytes of a block
  const auto leads = [&](double key) {
    return energy * (behind.share - ahead.share) > key * (kBitAValue - (behind.bytes - ahead.bytes));
  };
  return leads(window.low()) && leads(window.high());
}

/// Rungs of the transform and near ones that the window may choose. Where the point at which the search of one kind
/// begins is far ahead of the other's, the other kind has none.
template <typename At, typename NearAt>
LadderRange ranges_within(const KeyWindow& window, double energy, const RungSearch<At>& rungs,
                          const RungSearch<NearAt>& near) {
  const auto range_of = [&](const auto& search) {
    return rungs_within(window, energy, search.start, search.first, search.end, search.at);
  };
  const std::optional<RungPoint> point = rungs.point();
  const std::optional<RungPoint> near_point = near.point();
  const bool compares = point && near_point && window.means_have_codes();
  if (compares && is_far_ahead(window, energy, *point, *near_point)) {
    return {range_of(rungs), near.none(), false};  // what is finer than near rungs is behind, too
  }
  const bool near_alone = compares && is_far_ahead(window, energy, *near_point, *point);
  const RungRange range = range_of(near);
  return {near_alone ? rungs.none() : range_of(rungs), range, range.more};
}

/// Where the search of rungs_within() begins.
std::size_t start_rung(const KeyWindow& window, const PackedLadder& ladder);
std::size_t start_near_rung(const KeyWindow& window, const PackedLadder& ladder);

}  // namespace weir
