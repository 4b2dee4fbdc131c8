// Finds the cut: the key at which the budget ends. Purchases with higher keys are bought, the others are not. Each pass
// over the spilled rows divides the range of keys in which the cut lies.
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
  /// Weight that may stay unbought, if buying everything leaves no error. The search then sets `limit` to the weight of
  /// everything minus `left`. (The difference of two large sums would lose a small error.)
  std::optional<Weight> left = std::nullopt;

  Weight weight(std::uint64_t bytes, double gain) const;
  /// Returns whether all of `weight` may be bought on top of `bought`. A size is never exceeded; an error is brought
  /// down until the limit is reached.
  bool admits(Weight bought, Weight weight) const { return unit == 0 ? bought + weight <= limit : bought < limit; }
  /// Returns whether a whole class of keys can be bought without looking at its members.
  bool admits_all(Weight bought, Weight weight) const {
    return unit == 0 ? bought + weight <= limit : bought + weight < limit;
  }
};

/// Where buying ends.
struct Threshold {
  double key = 0;                  ///< everything above it is bought; 0: everything can be
  PurchaseGoal::Weight above = 0;  ///< the weight of everything above `key`
  /// Indices, rising, of the regions that have a purchase of exactly `key`, or are one. Absent if the search did not
  /// look.
  std::optional<std::vector<std::int64_t>> tied{};
  /// Bytes of everything with a key of at least `key`, except upper nodes. Set only if the goal is an error, the file
  /// has a preview and the steps are held.
  std::optional<std::uint64_t> bytes{};
};

class CutSearch {
 public:
  /// Searches the keys of `tree` (region_keys.h) and of the leaves' steps. All arguments must outlive the object.
  /// `held`: the steps of likely_keys(), or of every_key() if the goal is an error and error_unit() is not known
  /// beforehand; or null. `counts`: the bytes of the steps of likely_keys(), used if the goal is a size; or null.
  CutSearch(const GainRule& rule, const RowStore& rows, const TreeRegions& tree, const HeldSteps* held,
            const KeyCounts* counts)
      : rule_(rule), rows_(rows), tree_(tree), held_(held), counts_(counts) {}

  /// Returns the range of keys in which the search looks for the cut first.
  static KeyRange likely_keys(const GainRule& rule);
  /// Returns the range of all keys, kRequiredKey included.
  static KeyRange every_key();
  /// Returns the unit in which saved errors are summed, or 0 if it is not known before they are. The unit is 2^-112 of
  /// a bound of the error with nothing bought.
  static double error_unit(const GainRule& rule);

  /// Returns the smallest key for which everything above it can be bought for `goal`.
  Threshold find_threshold(PurchaseGoal& goal);

 private:
  Threshold search(PurchaseGoal& goal);
  // count() sums all purchases by `range`. count_steps() adds those below the upper nodes to `total`.
  KeyCounts count(const KeyRange& range, const PurchaseGoal& goal) const;
  void count_steps(const PurchaseGoal& goal, KeyCounts& total) const;
  // Holds the `items` steps of the range if there is room.
  void hold(const KeyRange& range, std::uint64_t items, const PurchaseGoal& goal);
  Threshold sorted_threshold(const PurchaseGoal& goal, PurchaseGoal::Weight above, const KeyRange& range) const;
  // Calls begin() for each region. Calls the function that begin() returned with each step in the region that can be
  // bought. Upper nodes are left out; steps with keys below `least_key` may be.
  template <typename Begin>
  void for_each_key(const Begin& begin, double least_key = 0) const;
  // The same with the parts of the held steps in place of regions: visits the steps in the held range.
  template <typename Begin>
  void for_each_held(const Begin& begin) const;
  bool holds(const KeyRange& range) const { return held_ != nullptr && held_->range().holds(range); }
  // Returns whether the weights outside the held range are known in the goal's unit.
  bool knows_outside(const PurchaseGoal& goal) const {
    return goal.unit == 0 || goal.unit == held_->unit() || holds(every_key());
  }

  const GainRule& rule_;
  const RowStore& rows_;
  const TreeRegions& tree_;
  const HeldSteps* held_;
  const KeyCounts* counts_;
  std::unique_ptr<HeldSteps> narrowed_;                         // steps of the range in which the cut was found
  mutable tbb::enumerable_thread_specific<RegionGains> gains_;  // of the region that a thread looks at
};

}  // namespace weir
