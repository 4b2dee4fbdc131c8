// Codes of exact blocks: prediction inside the block, and floats in the order of their bits (FORMAT.md, "Values of
// lattice blocks"). For host and device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"

namespace weir {

/// Where a lattice block's codes come from; as in its first byte.
enum class LatticeKind : std::uint8_t { file = 0, own = 1, ordered = 2 };

/// Predictors: 3-D Lorenzo, the neighbours' mean, their minimum, the median of three planes.
inline constexpr unsigned kPredictors = 4;

/// Of voxel (x, y, z) but (0, 0, 0), from the codes of those before it; `ordered`: codes are signed.
WEIR_HOST_DEVICE inline std::int64_t predict(unsigned predictor, bool ordered, const std::uint32_t* codes, unsigned x,
                                             unsigned y, unsigned z) {
  const std::uint32_t* at = codes + (x << 6U | y << 3U | z);
  const auto code = [&](unsigned back) {
    const std::uint32_t c = *(at - back);
    return ordered ? static_cast<std::int64_t>(static_cast<std::int32_t>(c)) : static_cast<std::int64_t>(c);
  };
  if (predictor == 1 || predictor == 2) {
    std::int64_t sum = 0;
    std::int64_t least = 0;
    std::int64_t count = 0;
    const auto add = [&](std::int64_t c) {
      least = count == 0 || c < least ? c : least;
      sum += c;
      ++count;
    };
    if (x > 0) add(code(64));
    if (y > 0) add(code(8));
    if (z > 0) add(code(1));
    if (predictor == 2) return least;
    const std::int64_t quotient = sum / count;
    return sum % count < 0 ? quotient - 1 : quotient;
  }
  if (x > 0 && y > 0 && z > 0) {
    if (predictor == 0) {
      return code(64) + code(8) + code(1) - code(72) - code(65) - code(9) + code(73);
    }
    const std::int64_t a = code(64) + code(8) - code(72);
    const std::int64_t b = code(64) + code(1) - code(65);
    const std::int64_t c = code(8) + code(1) - code(9);
    const std::int64_t low = a < b ? a : b;
    const std::int64_t high = a < b ? b : a;
    return c < low ? low : c > high ? high : c;
  }
  if (x > 0 && y > 0) return code(64) + code(8) - code(72);
  if (x > 0 && z > 0) return code(64) + code(1) - code(65);
  if (y > 0 && z > 0) return code(8) + code(1) - code(9);
  return x > 0 ? code(64) : y > 0 ? code(8) : code(1);
}

/// Residuals become codes; codes[0] is the base.
WEIR_HOST_DEVICE inline void undo_prediction(unsigned predictor, bool ordered, std::uint32_t* codes) {
  for (unsigned i = 1; i < 512; ++i) {
    codes[i] += static_cast<std::uint32_t>(predict(predictor, ordered, codes, i >> 6U, i >> 3U & 7U, i & 7U));
  }
}

WEIR_HOST_DEVICE inline float float_of_ordered(std::uint32_t code) {
  const std::uint32_t bits = code >> 31U != 0 ? code ^ 0x7FFFFFFFU : code;
  float value;
  __builtin_memcpy(&value, &bits, sizeof value);
  return value;
}

WEIR_HOST_DEVICE inline std::uint32_t ordered_of_float(float value) {
  std::uint32_t bits;
  __builtin_memcpy(&bits, &value, sizeof bits);
  return bits >> 31U != 0 ? bits ^ 0x7FFFFFFFU : bits;
}

}  // namespace weir
