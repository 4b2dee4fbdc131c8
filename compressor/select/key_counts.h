// Histograms of the weights of purchases over a range of keys.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "compressor/select/key_sums.h"

namespace weir {

/// Sums of purchases with keys in a range, in buckets of 2^shift consecutive keys (as bits), and sums of the purchases
/// with keys outside the range.
struct KeyCounts {
  // As many buckets as a core's cache holds.
  static constexpr std::uint64_t kMostBuckets = std::uint64_t{1} << 14U;

  explicit KeyCounts(const KeyRange& keys) : range(keys) {
    while ((range.end - range.first - 1) >> shift >= kMostBuckets) ++shift;
    buckets.resize(((range.end - range.first - 1) >> shift) + 1);
  }
  /// Adds a purchase. A key of 0 is ignored because it is never bought.
  void add(double key, PurchaseSum::Weight weight) {
    if (!(key > 0)) return;
    const PurchaseSum one{weight, 1};
    if (range.holds(key)) {
      buckets[(key_bits(key) - range.first) >> shift] += one;
    } else {
      outside.add(range, key, one);
    }
  }
  /// Adds counts of the same range.
  void operator+=(const KeyCounts& other) {
    for (std::size_t i = 0; i < buckets.size(); ++i) buckets[i] += other.buckets[i];
    outside += other.outside;
  }
  PurchaseSum::Weight all() const {
    PurchaseSum::Weight sum = 0;
    for (const PurchaseSum& bucket : buckets) sum += bucket.weight;
    for (const PurchaseSum& part : outside.parts) sum += part.weight;
    return sum;
  }
  KeyRange keys_of(std::size_t bucket) const {
    const std::uint64_t first = range.first + (std::uint64_t{bucket} << shift);
    return {first, std::min(range.end, first + (std::uint64_t{1} << shift))};
  }

  KeyRange range;
  unsigned shift = 0;
  std::vector<PurchaseSum> buckets;
  OutsideSums outside;
};

}  // namespace weir
