#include "compressor/select/cut_search.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "format/base/error.h"

namespace weir {
namespace {

// The keys of all purchases that are not required.
constexpr KeyRange kAllKeys{std::bit_cast<std::uint64_t>(kLastKey), std::bit_cast<std::uint64_t>(kRequiredKey)};

using CountsOfThreads = tbb::enumerable_thread_specific<KeyCounts>;

// Adds the counts of all threads to `total`. One thread would take as long to add the counts of 16 threads as the 16
// take to count.
void add_all(const CountsOfThreads& counts, KeyCounts& total) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, total.buckets.size(), 512), [&](const auto& range) {
    for (const KeyCounts& counted : counts) {
      for (std::size_t i = range.begin(); i < range.end(); ++i) total.buckets[i] += counted.buckets[i];
    }
  });
  for (const KeyCounts& counted : counts) total.outside += counted.outside;
}

}  // namespace

PurchaseGoal::Weight PurchaseGoal::weight(std::uint64_t bytes, double gain) const {
  return unit == 0 ? Weight{bytes} : gain_weight(gain, unit);
}

KeyRange CutSearch::likely_keys(const GainRule& rule) {
  if (!rule.packed || !rule.packed->window) return kAllKeys;
  return {key_bits(rule.packed->window->low()), key_bits(rule.packed->window->high()) + 1};
}

KeyRange CutSearch::every_key() { return {kAllKeys.first, kAllKeys.end + 1}; }

double CutSearch::error_unit(const GainRule& rule) {
  if (!rule.packed || rule.visibility != nullptr) return 0;  // a scene weighs errors
  const double unit = std::ldexp(rule.packed->most_error, -112);
  return std::isnormal(unit) ? unit : 0;
}

template <typename Begin>
void CutSearch::for_each_key(const Begin& begin, double least_key) const {
  for_each_own_region(tree_, rows_, [&](std::int64_t index, const RegionRows& rows) {
    const Region& region = tree_.regions[static_cast<std::size_t>(index)];
    const auto visit = begin();
    visit(HeldSteps::Step::opening(index, region.key, region.opening_gain));
    if (region.key == 0 || region.key < least_key) return;  // no leaf in it has a higher key
    RegionGains& gains = gains_.local();
    rule_.gains(tree_, rows, gains, least_key);
    for_each_step(gains, region.key, [&](double key, const LeafGain& leaf, const LeafStep& step) {
      visit(HeldSteps::Step::of_leaf(index, key, leaf.position, step));
    });
  });
}

template <typename Begin>
void CutSearch::for_each_held(const Begin& begin) const {
  const std::vector<std::span<const HeldSteps::Step>> pieces = held_->steps();
  tbb::parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t i) {
    const auto visit = begin();
    for (const HeldSteps::Step& step : pieces[i]) visit(step);
  });
}

KeyCounts CutSearch::count(const KeyRange& range, const PurchaseGoal& goal) const {
  KeyCounts total(range);
  if (counts_ != nullptr && goal.unit == 0 && counts_->range == range) {
    total = *counts_;
  } else {
    count_steps(goal, total);
  }
  for (const Upper& upper : tree_.uppers) total.add(upper.key, goal.weight(rule_.upper_bytes(), upper.opening_gain));
  return total;
}

void CutSearch::count_steps(const PurchaseGoal& goal, KeyCounts& total) const {
  CountsOfThreads local{KeyCounts(total.range)};
  const auto begin = [&] {
    return [&, &counted = local.local()](const HeldSteps::Step& step) {
      counted.add(step.key, goal.weight(step.bytes(rule_.region_bytes()), step.gain));
    };
  };
  if (holds(total.range) && knows_outside(goal)) {
    for_each_held(begin);
    total.outside = goal.unit == 0 ? held_->outside() : held_->outside_gains();
  } else {
    for_each_key(begin);
  }
  add_all(local, total);
  rows_.team().sum<PurchaseSum>(total.buckets);
  rows_.team().sum<PurchaseSum>(total.outside.parts);
}

void CutSearch::hold(const KeyRange& range, std::uint64_t items, const PurchaseGoal& goal) {
  if (holds(range) || goal.unit != 0 || !rows_.team().alone()) return;
  const std::uint64_t room = rows_.room().step_bytes / 2;  // the counts of the pass before still take memory
  if (HeldSteps::bytes_for(items) > room) return;
  narrowed_ = std::make_unique<HeldSteps>(range, room, rule_.region_bytes());
  const auto begin = [&] { return [&part = narrowed_->part()](const HeldSteps::Step& step) { part.add(step); }; };
  for_each_key(begin, std::bit_cast<double>(range.first));  // the cut is in the range: nothing below it is asked for
  if (narrowed_->complete()) held_ = narrowed_.get();
}

Threshold CutSearch::find_threshold(PurchaseGoal& goal) {
  Threshold found = search(goal);
  const bool previewed = rule_.packed && rule_.packed->preview;
  const bool all = found.key == 0;
  if (!previewed || goal.unit == 0 || held_ == nullptr || !(all || held_->range().holds(found.key))) return found;
  tbb::enumerable_thread_specific<std::uint64_t> bytes{0};
  for_each_held([&] {
    return [&, least = found.key, &sum = bytes.local()](const HeldSteps::Step& step) {
      if (step.key >= least) sum += step.bytes(rule_.region_bytes());
    };
  });
  const OutsideSums outside = held_->outside();
  found.bytes = static_cast<std::uint64_t>(outside[OutsideSums::required].weight + outside[OutsideSums::above].weight);
  if (all) *found.bytes += static_cast<std::uint64_t>(outside[OutsideSums::below].weight);
  found.bytes = std::accumulate(bytes.begin(), bytes.end(), *found.bytes);
  return found;
}

Threshold CutSearch::search(PurchaseGoal& goal) {
  constexpr std::uint64_t kSortedItems = std::uint64_t{1} << 15U;  // of 32 bytes
  KeyRange range = likely_keys(rule_);
  for (bool first = true;; first = false) {
    const KeyCounts counted = count(range, goal);
    if (first && goal.left) {
      const PurchaseGoal::Weight all = counted.all();
      goal.limit = all > *goal.left ? all - *goal.left : 0;
    }
    // Required purchases are bought for every goal.
    PurchaseGoal::Weight above = counted.outside[OutsideSums::required].weight;
    if (goal.unit != 0 && above >= goal.limit) return {std::numeric_limits<double>::max(), above};
    const PurchaseSum& higher = counted.outside[OutsideSums::above];
    if (higher.items > 0 && !goal.admits_all(above, higher.weight)) {
      range = {range.end, kAllKeys.end};
      continue;
    }
    above += higher.weight;
    std::size_t bucket = counted.buckets.size();
    while (bucket > 0 && goal.admits_all(above, counted.buckets[bucket - 1].weight)) {
      above += counted.buckets[--bucket].weight;
    }
    if (bucket == 0) {
      if (counted.outside[OutsideSums::below].items == 0) return {0, above};  // everything may be bought
      range = {kAllKeys.first, range.first};
      continue;
    }
    const std::uint64_t items = counted.buckets[bucket - 1].items;
    range = counted.keys_of(bucket - 1);
    if (range.end - range.first == 1) return {std::bit_cast<double>(range.first), above};
    if (items > kSortedItems) hold(range, items, goal);
    if (items <= kSortedItems) return sorted_threshold(goal, above, range);
  }
}

Threshold CutSearch::sorted_threshold(const PurchaseGoal& goal, PurchaseGoal::Weight above,
                                      const KeyRange& range) const {
  struct Purchase {
    double key;
    std::int64_t region;  // -1: an upper node
    PurchaseGoal::Weight weight;
  };
  tbb::enumerable_thread_specific<std::vector<Purchase>> local;
  const auto begin = [&] {
    return [&, &found = local.local()](const HeldSteps::Step& step) {
      if (!range.holds(step.key)) return;
      found.push_back({step.key, step.region, goal.weight(step.bytes(rule_.region_bytes()), step.gain)});
    };
  };
  holds(range) ? for_each_held(begin) : for_each_key(begin, std::bit_cast<double>(range.first));
  std::vector<Purchase> items;
  for (const std::vector<Purchase>& some : local) items.insert(items.end(), some.begin(), some.end());
  rows_.team().concatenate(items);
  for (const Upper& upper : tree_.uppers) {
    if (range.holds(upper.key)) items.push_back({upper.key, -1, goal.weight(rule_.upper_bytes(), upper.opening_gain)});
  }
  std::sort(items.begin(), items.end(),
            [](const Purchase& a, const Purchase& b) { return a.key != b.key ? a.key > b.key : a.region < b.region; });
  for (std::size_t i = 0; i < items.size();) {
    Threshold found{items[i].key, above, std::vector<std::int64_t>{}};
    PurchaseGoal::Weight weight = 0;
    for (; i < items.size() && items[i].key == found.key; ++i) {
      weight += items[i].weight;
      const std::int64_t region = items[i].region;
      if (region >= 0 && (found.tied->empty() || found.tied->back() != region)) found.tied->push_back(region);
    }
    if (!goal.admits_all(above, weight)) return found;
    above += weight;
  }
  throw Error(ErrorKind::internal, "the selection's cut lies in no bucket");
}

}  // namespace weir
