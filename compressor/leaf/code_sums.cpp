#include "compressor/leaf/code_sums.h"

#include <cstring>

#include "format/base/simd.h"

namespace weir {
namespace {

constexpr std::size_t kQuantiserLanes = 16;

// Pairwise, whatever the machine.
[[gnu::always_inline]] inline double sum(const Floats16& lanes) {
  const Floats8 eight = __builtin_shufflevector(lanes, lanes, 0, 1, 2, 3, 4, 5, 6, 7) +
                        __builtin_shufflevector(lanes, lanes, 8, 9, 10, 11, 12, 13, 14, 15);
  const auto four =
      __builtin_shufflevector(eight, eight, 0, 1, 2, 3) + __builtin_shufflevector(eight, eight, 4, 5, 6, 7);
  const auto two = four + __builtin_shufflevector(four, four, 2, 3, 2, 3);
  return static_cast<double>(two[0] + two[1]);
}

// The next 16 of `left` values; `filler` behind the last.
[[gnu::always_inline]] inline void load(const float* values, std::size_t left, float filler, Floats16& v) {
  if (left >= kQuantiserLanes) {
    std::memcpy(&v, values, sizeof v);
  } else {
    v = filler - Floats16{};
    std::memcpy(&v, values, left * sizeof(float));
  }
}

// The code of each value.
[[gnu::always_inline]] inline void nearest(const Floats16& v, const CodeLevels& l, Floats16& code) {
  const Floats16 zero{};
  const Floats16 top = l.top - zero;
  Floats16 t = (v - l.minimum) * l.reciprocal;
  t = t > zero ? t : zero;
  t = t < top ? t : top;
  code = (t + kRounder) - kRounder;
}

}  // namespace

WEIR_SIMD double deviate(const float* values, std::size_t count, float mean, float scale, float* deviations) {
  Floats16 squares{};
  for (std::size_t i = 0; i < count; i += kQuantiserLanes) {
    Floats16 v;
    load(values + i, count - i, mean, v);
    const Floats16 d = (v - mean) * scale;
    squares += d * d;
    std::memcpy(deviations + i, &d, sizeof d);
  }
  return sum(squares);
}

// Adding a deviation is adding its product with 1.
WEIR_SIMD CodeSums assign_bit(const float* values, const float* deviations, std::size_t count,
                              const CodeLevels& levels) {
  const CodeLevels l = levels;
  const Floats16 zero{};
  Floats16 codes{};
  Floats16 code_values{};
  if (l.top > 0) {
    for (std::size_t i = 0; i < count; i += kQuantiserLanes) {
      Floats16 v;
      Floats16 d;
      load(values + i, count - i, l.minimum, v);
      std::memcpy(&d, deviations + i, sizeof d);
      const auto upper = (v - l.minimum) * l.reciprocal > 0.5F;  // a half goes to the even code
      codes += upper ? 1.0F - zero : zero;
      code_values += upper ? d : zero;
    }
  }
  const double ones = sum(codes);
  return {0, ones, ones, sum(code_values)};
}

WEIR_SIMD CodeSums assign(const float* values, const float* deviations, std::size_t count, const CodeLevels& levels) {
  const CodeLevels l = levels;
  Floats16 codes{};
  Floats16 code_squares{};
  Floats16 code_values{};
  for (std::size_t i = 0; i < count; i += kQuantiserLanes) {
    Floats16 v;
    Floats16 d;
    Floats16 code;
    load(values + i, count - i, l.minimum, v);
    std::memcpy(&d, deviations + i, sizeof d);
    nearest(v, l, code);  // behind the last value 0, which adds nothing
    codes += code;
    code_squares += code * code;
    code_values += code * d;
  }
  return {0, sum(codes), sum(code_squares), sum(code_values)};
}

WEIR_SIMD double measure_squares(const float* values, std::size_t count, const CodeLevels& levels, float scale) {
  const CodeLevels l = levels;
  Floats16 squares{};
  for (std::size_t i = 0; i < count; i += kQuantiserLanes) {
    Floats16 v;
    Floats16 code;
    load(values + i, count - i, l.minimum, v);
    nearest(v, l, code);
    const Floats16 error = (v - (code * l.quantum + l.minimum)) * scale;
    squares += error * error;
  }
  return sum(squares);
}

WEIR_SIMD void nearest_codes(const float* values, std::size_t count, const CodeLevels& levels, std::uint16_t* codes) {
  const CodeLevels l = levels;
  for (std::size_t i = 0; i < count; ++i) {
    float t = (values[i] - l.minimum) * l.reciprocal;
    t = t > 0.0F ? t : 0.0F;
    t = t < l.top ? t : l.top;
    codes[i] = static_cast<std::uint16_t>(static_cast<std::int32_t>((t + kRounder) - kRounder));
  }
}

}  // namespace weir
