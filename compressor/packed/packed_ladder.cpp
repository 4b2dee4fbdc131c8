#include "compressor/packed/packed_ladder.h"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace weir {

// The nearest one, and of two the even one, by the bits of the double: conversions make millions of them.
ErrorShare::ErrorShare(double share) {
  constexpr int kDropped = 52 - kMantissaBits;
  if (!(share > 0)) return;
  const auto bits = std::bit_cast<std::uint64_t>(std::min(share, 1.0));
  const std::uint64_t to_even = (std::uint64_t{1} << (kDropped - 1)) - 1 + (bits >> kDropped & 1U);
  const std::uint64_t rounded = (bits + to_even) >> kDropped;  // exponent and mantissa; a carry goes into the exponent
  const std::uint64_t e = 1023 - (rounded >> kMantissaBits);
  if (e > kLargestExponent) return;
  code_ = static_cast<std::uint16_t>(e << kMantissaBits | (rounded & ((1U << kMantissaBits) - 1U)));
}

}  // namespace weir
