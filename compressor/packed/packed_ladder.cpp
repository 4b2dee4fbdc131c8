#include "compressor/packed/packed_ladder.h"

#include <algorithm>
#include <cmath>

namespace weir {

ErrorShare::ErrorShare(double share) {
  if (!(share > 0)) return;
  int exponent = 0;
  const double mantissa = 2 * std::frexp(std::min(share, 1.0), &exponent);  // in [1, 2)
  int e = 1 - exponent;
  int m = static_cast<int>(std::nearbyint((mantissa - 1) * (1 << kMantissaBits)));
  if (m == 1 << kMantissaBits) {
    m = 0;
    --e;
  }
  if (e > kLargestExponent) return;
  code_ = static_cast<std::uint16_t>(std::max(e, 0) << kMantissaBits | m);
}

}  // namespace weir
