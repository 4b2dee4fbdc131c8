#include "compressor/leaf/exact_sum.h"

#include <bit>
#include <cmath>

namespace weir {
namespace {

constexpr unsigned kDigitBits = 32;
constexpr std::uint64_t kDigitMask = 0xffffffffU;
constexpr int kLowestExponent = -1074;

}  // namespace

void ExactSum::add(double term) {
  const auto bits = std::bit_cast<std::uint64_t>(term);
  const std::uint64_t exponent = bits >> 52U & 0x7ffU;
  std::uint64_t mantissa = bits & ((std::uint64_t{1} << 52U) - 1);
  if (exponent != 0) mantissa |= std::uint64_t{1} << 52U;
  // The position of the mantissa's lowest bit. Denormals have the position of the smallest normal numbers.
  const std::uint64_t position = exponent == 0 ? 0 : exponent - 1;
  const std::uint64_t digit = position / kDigitBits;
  const auto shift = static_cast<unsigned>(position % kDigitBits);
  // 53 bits shifted by up to 31 span three digits.
  const std::uint64_t low = (mantissa & kDigitMask) << shift;
  const std::uint64_t high = (mantissa >> kDigitBits) << shift;
  digits_[digit] += low & kDigitMask;
  digits_[digit + 1] += (low >> kDigitBits) + (high & kDigitMask);
  digits_[digit + 2] += high >> kDigitBits;
  if (++terms_ == kTermsPerCarry) carry();
}

void ExactSum::add(const ExactSum& other) {
  ExactSum normal = other;
  normal.carry();
  carry();
  for (std::size_t i = 0; i < kDigits; ++i) digits_[i] += normal.digits_[i];
  carry();
}

double ExactSum::value() const {
  ExactSum normal = *this;
  normal.carry();
  // Adds from the lowest digit up, so that all rounding stays below the last place of the result.
  double sum = 0.0;
  for (std::size_t i = 0; i < kDigits; ++i) {
    if (normal.digits_[i] == 0) continue;
    sum += std::ldexp(static_cast<double>(normal.digits_[i]), static_cast<int>(i * kDigitBits) + kLowestExponent);
  }
  return sum;
}

void ExactSum::carry() {
  std::uint64_t over = 0;
  for (std::uint64_t& digit : digits_) {
    digit += over;
    over = digit >> kDigitBits;
    digit &= kDigitMask;
  }
  terms_ = 0;
}

}  // namespace weir
