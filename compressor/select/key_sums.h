// What purchases come to, by their keys.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "compressor/select/step_keys.h"

namespace weir {

/// Bytes, or saved error in the units of a PurchaseGoal (cut_search.h).
struct PurchaseSum {
  // Whole numbers, so that sums do not depend on the order of the threads.
  using Weight = unsigned __int128;
  Weight weight = 0;
  std::uint64_t items = 0;
  void operator+=(const PurchaseSum& other) {
    weight += other.weight;
    items += other.items;
  }
};

/// A saved error in units of `unit`, an error too.
inline PurchaseSum::Weight gain_weight(double gain, double unit) {
  return static_cast<PurchaseSum::Weight>(std::max(0.0, gain) / unit);
}

/// Of purchases whose keys are not in a range.
struct OutsideSums {
  enum Part : std::size_t { required, above, below };
  std::array<PurchaseSum, 3> parts{};

  void add(const KeyRange& range, double key, const PurchaseSum& sum) {
    parts[key == kRequiredKey ? required : key_bits(key) < range.first ? below : above] += sum;
  }
  void operator+=(const OutsideSums& other) {
    for (std::size_t i = 0; i < parts.size(); ++i) parts[i] += other.parts[i];
  }
  const PurchaseSum& operator[](Part part) const { return parts[part]; }
};

}  // namespace weir
