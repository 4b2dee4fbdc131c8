// The exact sum of any number of doubles. It has the same bits for every order and grouping of the terms, so that
// parallel reductions need no order and no storage.
#pragma once

#include <array>
#include <cstdint>

namespace weir {

/// A fixed-point number that covers the whole range of double (U. Kulisch, "Computer Arithmetic and Validity", 2008).
/// It holds digits of 32 bits in 64-bit places, so that carries are needed only every 2^30 terms.
class ExactSum {
 public:
  /// Adds `term`, which must be finite and not negative.
  void add(double term);
  void add(const ExactSum& other);
  /// Returns the sum, rounded to within one unit in the last place. Equal sums give the same result.
  double value() const;

 private:
  // Bit 0 of digit 0 is 2^-1074; 2^1024 is bit 2098, and 2^46 terms of that size reach bit 2144.
  static constexpr std::size_t kDigits = 68;
  static constexpr std::uint32_t kTermsPerCarry = 1U << 30U;

  void carry();

  std::array<std::uint64_t, kDigits> digits_{};
  std::uint32_t terms_ = 0;
};

}  // namespace weir
