// Sums of purchases: their weight and number, also split by whether their keys are required, above or below a range.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "compressor/select/step_keys.h"

namespace weir {

/// A sum of purchases. `weight` is bytes, or saved error in the units of a PurchaseGoal (cut_search.h).
struct PurchaseSum {
  // Integers, so that sums do not depend on the order of the threads.
  using Weight = unsigned __int128;
  Weight weight = 0;
  std::uint64_t items = 0;
  void operator+=(const PurchaseSum& other) {
    weight += other.weight;
    items += other.items;
  }
};

/// Returns the integer part of `value`, which is 0 (of either sign) or positive and below 2^128. Works on the bits
/// because the compiler's conversion is a function call.
inline PurchaseSum::Weight whole_part(double value) {
  constexpr int kMantissaBits = 52;
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const int shift = static_cast<int>(bits >> kMantissaBits & 0x7FFU) - 1023 - kMantissaBits;
  if (shift < -kMantissaBits) return 0;  // below 1
  const std::uint64_t digits = (bits & ((std::uint64_t{1} << kMantissaBits) - 1)) | std::uint64_t{1} << kMantissaBits;
  return shift < 0 ? digits >> -shift : PurchaseSum::Weight{digits} << shift;
}

/// Returns the saved error `gain` in units of the error `unit`; 0 if `gain` is negative.
inline PurchaseSum::Weight gain_weight(double gain, double unit) { return whole_part(std::max(0.0, gain) / unit); }

/// Sums of purchases with keys outside a range.
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
