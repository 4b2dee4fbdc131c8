// The rungs of a ladder that a budget can choose, once the place of its cut is roughly known. The survey then builds
// three to five rungs of some twenty. The choice stays the same: for a cut within the window, the best of all rungs is
// among the built ones, as long as each further byte of a block saves less error than the byte before.
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

/// A range of keys (squared error saved per byte) in which the cut of a selection lies.
class KeyWindow {
 public:
  /// A sample of the blocks nearly always tells the cut within this factor.
  static constexpr double kMostReach = 2.5;

  /// The window from `centre` / `reach` to `centre` * `reach`. `centre` is a normal number > 0, `reach` is > 1. The
  /// volume's values lie in a range of about `width`.
  KeyWindow(double centre, float width, double reach = kMostReach)
      : centre_(centre), reach_(reach), width_(width), step_(coarsest_step_within(quantum())) {}
  /// Returns a window about `key`; nullopt if the key is so small that no error is left to save.
  static std::optional<KeyWindow> about(double key, float width, double reach = kMostReach) {
    return key >= std::numeric_limits<double>::min() ? std::optional(KeyWindow(key, width, reach)) : std::nullopt;
  }

  double centre() const { return centre_; }
  double reach() const { return reach_; }
  float width() const { return width_; }
  double low() const { return centre_ / reach_; }
  double high() const { return centre_ * reach_; }
  bool holds(double key) const { return key >= low() && key <= high(); }
  /// Returns the step size of a quantiser for which a byte saves an error of centre(). The uniform error is size^2 / 12
  /// a value; halving the step takes a bit a value and saves size^2 / 2 a byte.
  double quantum() const { return std::sqrt(2 * centre_); }
  /// Returns the coarsest step with a size of at most quantum(), or the finest step.
  std::int32_t step() const { return step_; }
  /// Returns the exponent of quantum().
  int exponent() const { return exponent_; }
  /// Returns whether means have codes in each region at the steps that the cut may choose. A rung without a code for
  /// its mean is useless.
  bool means_have_codes() const {
    constexpr std::int32_t kOctave = 2;
    return step_ + kOctave <= kMostStep && mean_bits({0, width_}, step_ + kOctave) != kNoMeanBits;
  }
  /// Returns the window in the form that a coder takes.
  SearchKeys keys() const { return {low(), high(), means_have_codes()}; }

 private:
  double centre_;
  double reach_;
  float width_;
  std::int32_t step_;
  int exponent_ = std::ilogb(quantum());
};

/// The adjacent rungs [first, end); none if first == end.
struct RungRange {
  std::size_t first = 0;
  std::size_t end = 0;
  bool more = true;  ///< a finer way to keep the block may be chosen, too
  bool has(std::size_t rung) const { return rung >= first && rung < end; }
};

/// Returns the rungs of [first, end), from coarse to fine, that the window may choose. `start` is roughly in the middle
/// of the result. `energy` is the error of a block without a rung. at(rung) returns the rung's point, or nullopt if
/// there is none; it is called only for rungs that decide the result. The result does not depend on whether further
/// rungs have points.
template <typename At>
RungRange rungs_within(const KeyWindow& window, double energy, std::size_t start, std::size_t first, std::size_t end,
                       const At& at) {
  if (first >= end) return {first, first, true};
  std::size_t coarse = std::min(std::max(start, first), end - 1);
  std::optional<RungPoint> point = at(coarse);
  while (!point && coarse > first) point = at(--coarse);
  if (!point) return {first, first, true};
  // Costs are in whole bytes: a rung ends the search only if, at the window's key, it costs a byte more than the best
  // rung so far.
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

/// The rungs of a ladder that a window may choose. The mean alone, at rungs 0 and 1, is always kept. The ladder may
/// have been built with this window, or without a window.
struct LadderRange {
  RungRange rungs;
  RungRange near;
  bool more = true;  ///< a way to keep the block that is finer than all these rungs may be chosen, too
};
LadderRange range_within(const KeyWindow& window, const PackedLadder& ladder, const LeafRow& row);

/// Rungs to search with rungs_within().
template <typename At>
struct RungSearch {
  std::size_t start;
  std::size_t first;
  std::size_t end;
  const At& at;

  /// Returns the point at which the search begins; nullopt if there is none.
  std::optional<RungPoint> point() const {
    if (first >= end) return std::nullopt;
    return at(std::min(std::max(start, first), end - 1));
  }
  RungRange none() const { return {first, first, true}; }
};
template <typename At>
RungSearch(std::size_t, std::size_t, std::size_t, const At&) -> RungSearch<At>;

/// Returns whether, at every key of the window, `ahead` is so much the better buy than `behind` that no rung next to
/// `behind` is chosen. These rungs are at most about a bit a value better than the rung at which a search begins.
inline bool is_far_ahead(const KeyWindow& window, double energy, const RungPoint& ahead, const RungPoint& behind) {
  constexpr double kBitAValue = kLeafVoxels / 8.0;  // bytes of a block
  const auto leads = [&](double key) {
    return energy * (behind.share - ahead.share) > key * (kBitAValue - (behind.bytes - ahead.bytes));
  };
  return leads(window.low()) && leads(window.high());
}

/// Returns the transform rungs and the near rungs that the window may choose. If the search of one kind begins at a
/// point far ahead of the other kind's, the other kind has no rungs.
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
    return {range_of(rungs), near.none(), false};  // a way finer than near rungs is behind, too
  }
  const bool near_alone = compares && is_far_ahead(window, energy, *near_point, *point);
  const RungRange range = range_of(near);
  return {near_alone ? rungs.none() : range_of(rungs), range, range.more};
}

/// Return the rung at which the search of rungs_within() begins.
std::size_t start_rung(const KeyWindow& window, const PackedLadder& ladder);
std::size_t start_near_rung(const KeyWindow& window, const PackedLadder& ladder);

}  // namespace weir
