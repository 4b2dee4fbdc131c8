// Where the budget ends in the order of keys: the cut between what is bought and
// what is not, found in passes over the spilled rows, each of which divides the
// range of keys that it lies in.
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "compressor/select/held_steps.h"
#include "compressor/select/key_counts.h"
#include "compressor/select/leaf_gain.h"
#include "compressor/select/region_rows.h"
#include "compressor/select/step_keys.h"
#include "compressor/select/tree_regions.h"

namespace weir {

/// What a purchase counts against the goal: its bytes, or the error it saves in units of `unit`.
struct PurchaseGoal {
  double unit = 0;  ///< squared error; 0: bytes count
  using Weight = PurchaseSum::Weight;
  Weight limit = 0;
  /// Weight that may stay unbought, where buying everything leaves no error: the search then sets `limit` to the weight
  /// of everything less this. The difference of two large sums would lose a small error.
  std::optional<Weight> left = std::nullopt;

  Weight weight(std::uint64_t bytes, double gain) const;
  /// Whether all of `weight`, on top of what is bought, may be bought. A size is never exceeded; an error is
  /// brought down until the limit is reached.
  bool admits(Weight bought, Weight weight) const { return unit == 0 ? bought + weight <= limit : bought < limit; }
  /// Whether a whole class of keys can be bought without looking at its members.
  bool admits_all(Weight bought, Weight weight) const {
    return unit == 0 ? bought + weight <= limit : bought + weight < limit;
  }
};

/// Where buying ends.
struct Threshold {
  double key = 0;                  ///< everything above it is bought; 0: everything can be
  PurchaseGoal::Weight above = 0;  ///< the sum of that
  /// Regions, rising, that have something of that very key, or are it; none where the search did not look.
  std::optional<std::vector<std::int64_t>> tied{};
  /// Bytes of all that has that key or a higher one, but for upper nodes: of an error's, with a preview, where the
  /// steps are held.
  std::optional<std::uint64_t> bytes{};
};

class CutSearch {
 public:
  /// Over the keys of `tree` (region_keys.h) and of the leaves' steps; all must outlive the object. `held`: the steps
  /// of likely_keys(), or of every_key() where an error is the goal whose unit is not known before (error_unit()), or
  /// null. `counts`: what those of likely_keys() take, or null.
  CutSearch(const GainRule& rule, const RowStore& rows, const TreeRegions& tree, const HeldSteps* held,
            const KeyCounts* counts)
      : rule_(rule), rows_(rows), tree_(tree), held_(held), counts_(counts) {}

  /// Where the cut is looked for first.
  static KeyRange likely_keys(const GainRule& rule);
  /// Of what is required, too.
  static KeyRange every_key();
  /// The unit that saved errors are summed in, where it is known before they are: a bound of the error of nothing
  /// bought is 2^112 of it. 0 where it is not.
  static double error_unit(const GainRule& rule);

  /// The smallest key for which everything above it can be bought for `goal`.
  Threshold find_threshold(PurchaseGoal& goal);

 private:
  Threshold search(PurchaseGoal& goal);
  // Of all that can be bought, by the range; and without the upper nodes.
  KeyCounts count(const KeyRange& range, const PurchaseGoal& goal) const;
  void count_steps(const PurchaseGoal& goal, KeyCounts& total) const;
  // Holds the `items` steps of the range where there is room.
  void hold(const KeyRange& range, std::uint64_t items, const PurchaseGoal& goal);
  Threshold sorted_threshold(const PurchaseGoal& goal, PurchaseGoal::Weight above, const KeyRange& range) const;
  // Calls begin() for each region, and what that returned with each step below the upper nodes that can be bought
  // there; what has a key below `least_key` may be left out.
  template <typename Begin>
  void for_each_key(const Begin& begin, double least_key = 0) const;
  // The same with the parts of the held steps, of their range.
  template <typename Begin>
  void for_each_held(const Begin& begin) const;
  bool holds(const KeyRange& range) const { return held_ != nullptr && held_->range().holds(range); }
  // Whether what lies outside of the held range is known in the goal's weights.
  bool knows_outside(const PurchaseGoal& goal) const {
    return goal.unit == 0 || goal.unit == held_->unit() || holds(every_key());
  }

  const GainRule& rule_;
  const RowStore& rows_;
  const TreeRegions& tree_;
  const HeldSteps* held_;
  const KeyCounts* counts_;
  std::unique_ptr<HeldSteps> narrowed_;                         // of the range that the cut was found in
  mutable tbb::enumerable_thread_specific<RegionGains> gains_;  // of the region that a thread looks at
};

}  // namespace weir
