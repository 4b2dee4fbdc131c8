// The codes of exact blocks: prediction inside the block, and floats in the order of their bits (FORMAT.md, "Values of
// lattice blocks"). For host and device.
#pragma once

#include <cstdint>

#include "format/base/host_device.h"

namespace weir {

/// The source of a lattice block's codes, as in its first byte.
enum class LatticeKind : std::uint8_t { file = 0, own = 1, ordered = 2 };

/// The number of predictors: 3-D Lorenzo, the neighbours' mean, their minimum, the median of three planes.
inline constexpr unsigned kPredictors = 4;

/// Predicts the code of the voxel at `at` from the codes of the neighbours before it. They lie kX, kY and 1 back along
/// x, y and z; the corners between them count too. `has_x`, `has_y` and `has_z` tell which neighbours exist; at least
/// one does. `ordered`: codes are signed. Sum must hold the sum of three codes.
template <class Sum, unsigned kX, unsigned kY>
WEIR_HOST_DEVICE inline Sum predict_at(unsigned predictor, bool ordered, const std::uint32_t* at, bool has_x,
                                       bool has_y, bool has_z) {
  const auto code = [&](unsigned back) {
    const std::uint32_t c = *(at - back);
    return ordered ? static_cast<Sum>(static_cast<std::int32_t>(c)) : static_cast<Sum>(c);
  };
  if (predictor == 1 || predictor == 2) {
    Sum sum = 0;
    Sum least = 0;
    unsigned count = 0;
    const auto add = [&](Sum c) {
      least = count == 0 || c < least ? c : least;
      sum += c;
      ++count;
    };
    if (has_x) add(code(kX));
    if (has_y) add(code(kY));
    if (has_z) add(code(1));
    if (predictor == 2) return least;
    if (count < 3) return sum >> (count - 1);  // floor
    const Sum third = sum / 3;
    return sum - 3 * third < 0 ? third - 1 : third;
  }
  if (has_x && has_y && has_z) {
    if (predictor == 0) {
      return code(kX) + code(kY) + code(1) - code(kX + kY) - code(kX + 1) - code(kY + 1) + code(kX + kY + 1);
    }
    const Sum a = code(kX) + code(kY) - code(kX + kY);
    const Sum b = code(kX) + code(1) - code(kX + 1);
    const Sum c = code(kY) + code(1) - code(kY + 1);
    const Sum low = a < b ? a : b;
    const Sum high = a < b ? b : a;
    return c < low ? low : c > high ? high : c;
  }
  if (has_x && has_y) return code(kX) + code(kY) - code(kX + kY);
  if (has_x && has_z) return code(kX) + code(1) - code(kX + 1);
  if (has_y && has_z) return code(kY) + code(1) - code(kY + 1);
  return has_x ? code(kX) : has_y ? code(kY) : code(1);
}

/// Predicts the code of voxel (x, y, z), which is not (0, 0, 0), from the codes of voxels before it. `ordered`: codes
/// are signed.
WEIR_HOST_DEVICE inline std::int64_t predict(unsigned predictor, bool ordered, const std::uint32_t* codes, unsigned x,
                                             unsigned y, unsigned z) {
  return predict_at<std::int64_t, 64, 8>(predictor, ordered, codes + (x << 6U | y << 3U | z), x > 0, y > 0, z > 0);
}

/// Turns residuals into codes, in place; codes[0] is the base.
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
