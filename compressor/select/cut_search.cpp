#include "compressor/select/cut_search.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <vector>

#include "compressor/select/step_keys.h"
#include "format/base/error.h"
#include "format/layout/nanovdb_layout.h"

namespace weir {

PurchaseGoal::Weight PurchaseGoal::weight(std::uint64_t bytes, double gain) const {
  return unit == 0 ? Weight{bytes} : static_cast<Weight>(std::max(0.0, gain) / unit);
}

// Calls visit(region, key, bytes, gain) for everything below the upper nodes that can be bought.
template <typename Visit>
void CutSearch::for_each_key(const Visit& visit) const {
  for_each_own_region(tree_, rows_, [&](std::int64_t index, const RegionRows& rows) {
    const Region& region = tree_.regions[static_cast<std::size_t>(index)];
    visit(index, region.key, rule_.region_bytes(), region.opening_gain);
    if (region.key == 0) return;  // no leaf in it has a higher one
    RegionGains& gains = gains_.local();
    rule_.gains(tree_, rows, gains);
    for (const LeafGain& leaf : gains) {
      for (std::uint32_t i = 0; i < leaf.step_count; ++i) {
        visit(index, step_key(leaf, i, region.key), leaf.steps[i].bytes, leaf.steps[i].gain);
      }
    }
  });
}

Threshold CutSearch::find_threshold(PurchaseGoal& goal) const {
  // Radix selection from the top: 16 bits of the keys a pass, weights counted per bucket, until the bucket
  // that the goal is reached in is small enough to be sorted.
  constexpr int kDigit = 16;
  constexpr std::size_t kBuckets = std::size_t{1} << kDigit;
  constexpr std::uint64_t kSortedItems = std::uint64_t{1} << 15U;  // of 32 bytes
  struct Bucket {
    PurchaseGoal::Weight weight = 0;
    std::uint64_t items = 0;
    void operator+=(const Bucket& other) {
      weight += other.weight;
      items += other.items;
    }
  };
  using Buckets = std::vector<Bucket>;
  std::uint64_t prefix = 0;
  PurchaseGoal::Weight above = 0;
  for (int shift = 64 - kDigit; shift >= 0; shift -= kDigit) {
    // What is required is bought whatever the goal.
    const auto matches = [&](double key, int bits) {
      return key > 0 && key != kRequiredKey && (bits == 64 || key_bits(key) >> bits == prefix);
    };
    tbb::enumerable_thread_specific<Buckets> local(kBuckets);
    tbb::enumerable_thread_specific<PurchaseGoal::Weight> required(0);
    const auto count = [&](Buckets& buckets, double key, PurchaseGoal::Weight weight) {
      if (key == kRequiredKey) required.local() += weight;
      if (!matches(key, shift + kDigit)) return;
      Bucket& bucket = buckets[key_bits(key) >> shift & (kBuckets - 1)];
      bucket.weight += weight;
      ++bucket.items;
    };
    for_each_key([&](std::int64_t, double key, std::uint64_t bytes, double gain) {
      count(local.local(), key, goal.weight(bytes, gain));
    });
    Buckets total(kBuckets);
    for (const Buckets& buckets : local) {
      for (std::size_t i = 0; i < kBuckets; ++i) total[i] += buckets[i];
    }
    rows_.team().sum<Bucket>(total);
    PurchaseGoal::Weight all_required = required.combine(std::plus<>());
    rows_.team().sum<PurchaseGoal::Weight>({&all_required, 1});
    required.clear();
    for (const Upper& upper : tree_.uppers) {
      count(total, upper.key, goal.weight(rule_.upper_bytes(), upper.opening_gain));
    }
    if (prefix == 0 && shift == 64 - kDigit) {
      above += all_required + required.combine(std::plus<>());
      if (goal.left) {
        PurchaseGoal::Weight all = above;
        for (const Bucket& bucket : total) all += bucket.weight;
        goal.limit = all > *goal.left ? all - *goal.left : 0;
      }
      if (goal.unit != 0 && above >= goal.limit) return {std::numeric_limits<double>::max(), above};
    }
    std::size_t bucket = kBuckets;
    while (bucket > 0 && goal.admits_all(above, total[bucket - 1].weight)) above += total[--bucket].weight;
    if (bucket == 0) return {0, above};  // everything may be bought
    prefix = prefix << kDigit | (bucket - 1);
    if (shift == 0) break;
    if (total[bucket - 1].items <= kSortedItems) {
      return sorted_threshold(goal, above, [&](double key) { return matches(key, shift); });
    }
  }
  return {std::bit_cast<double>(prefix), above};
}

Threshold CutSearch::sorted_threshold(const PurchaseGoal& goal, PurchaseGoal::Weight above,
                                      const std::function<bool(double)>& matches) const {
  struct Purchase {
    double key;
    std::int64_t region;  // -1: an upper node
    PurchaseGoal::Weight weight;
  };
  tbb::enumerable_thread_specific<std::vector<Purchase>> local;
  for_each_key([&](std::int64_t region, double key, std::uint64_t bytes, double gain) {
    if (matches(key)) local.local().push_back({key, region, goal.weight(bytes, gain)});
  });
  std::vector<Purchase> items;
  for (const std::vector<Purchase>& some : local) items.insert(items.end(), some.begin(), some.end());
  rows_.team().concatenate(items);
  for (const Upper& upper : tree_.uppers) {
    if (matches(upper.key)) items.push_back({upper.key, -1, goal.weight(rule_.upper_bytes(), upper.opening_gain)});
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
