#include "compressor/leaf/finite_values.h"

#include <cstdint>

#include "format/base/simd.h"

namespace weir {

WEIR_SIMD bool all_finite(const LeafValues& values) {
  std::uint32_t others = 0;
  for (const float v : values) others |= v - v == 0.0F ? 0U : 1U;  // v - v is NaN if v is not finite
  return others == 0;
}

}  // namespace weir
