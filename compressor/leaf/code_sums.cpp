#include "compressor/leaf/code_sums.h"

#include <cstring>

#include "format/base/simd.h"

namespace weir {
namespace {

// 16 lanes as two vectors of eight, because vectors wider than the machine's are compared lane by lane.
constexpr std::size_t kHalf = 8;
struct Lanes {
  Floats8 low{};
  Floats8 high{};
};

// Sums the lanes pairwise, in the same order on every machine.
[[gnu::always_inline]] inline double sum(const Lanes& lanes) {
  const Floats8 eight = lanes.low + lanes.high;
  const auto four =
      __builtin_shufflevector(eight, eight, 0, 1, 2, 3) + __builtin_shufflevector(eight, eight, 4, 5, 6, 7);
  const auto two = four + __builtin_shufflevector(four, four, 2, 3, 2, 3);
  return static_cast<double>(two[0] + two[1]);
}

[[gnu::always_inline]] inline void load_half(const float* values, std::size_t first, std::size_t count, float filler,
                                             Floats8& v) {
  if (first + kHalf <= count) {
    std::memcpy(&v, values + first, sizeof v);
  } else {
    v = filler - Floats8{};
    if (first < count) std::memcpy(&v, values + first, (count - first) * sizeof(float));
  }
}

// Loads 16 values from `first` on, with `filler` behind the last value.
[[gnu::always_inline]] inline void load(const float* values, std::size_t first, std::size_t count, float filler,
                                        Lanes& v) {
  load_half(values, first, count, filler, v.low);
  load_half(values, first + kHalf, count, filler, v.high);
}

// Each *_half function does the work of a function below for one half of the lanes.

[[gnu::always_inline]] inline void deviate_half(const Floats8& v, float mean, float scale, float* deviations,
                                                Floats8& squares) {
  const Floats8 d = (v - mean) * scale;
  squares += d * d;
  std::memcpy(deviations, &d, sizeof d);
}

[[gnu::always_inline]] inline void assign_bit_half(const Floats8& v, const float* deviations, const CodeLevels& l,
                                                   Floats8& codes, Floats8& code_values) {
  const Floats8 zero{};
  Floats8 d;
  std::memcpy(&d, deviations, sizeof d);
  const auto upper = (v - l.minimum) * l.reciprocal > 0.5F;  // a half goes to the even code
  codes += upper ? 1.0F - zero : zero;
  code_values += upper ? d : zero;  // for code 1, the product with the deviation is the deviation
}

[[gnu::always_inline]] inline void assign_half(const Floats8& v, const float* deviations, const CodeLevels& l,
                                               Floats8& codes, Floats8& code_squares, Floats8& code_values) {
  Floats8 d;
  Floats8 code;
  std::memcpy(&d, deviations, sizeof d);
  nearest_code(v, l, code);  // the code behind the last value is 0, which adds nothing
  codes += code;
  code_squares += code * code;
  code_values += code * d;
}

[[gnu::always_inline]] inline void measure_half(const Floats8& v, const CodeLevels& l, float scale, Floats8& squares) {
  Floats8 code;
  nearest_code(v, l, code);
  const Floats8 error = (v - (code * l.quantum + l.minimum)) * scale;
  squares += error * error;
}

}  // namespace

WEIR_SIMD double deviate(const float* values, std::size_t count, float mean, float scale, float* deviations) {
  Lanes squares;
  for (std::size_t i = 0; i < count; i += 2 * kHalf) {
    Lanes v;
    load(values, i, count, mean, v);
    deviate_half(v.low, mean, scale, deviations + i, squares.low);
    deviate_half(v.high, mean, scale, deviations + i + kHalf, squares.high);
  }
  return sum(squares);
}

WEIR_SIMD CodeSums assign_bit(const float* values, const float* deviations, std::size_t count,
                              const CodeLevels& levels) {
  const CodeLevels l = levels;
  Lanes codes;
  Lanes code_values;
  for (std::size_t i = 0; i < count && l.top > 0; i += 2 * kHalf) {
    Lanes v;
    load(values, i, count, l.minimum, v);
    assign_bit_half(v.low, deviations + i, l, codes.low, code_values.low);
    assign_bit_half(v.high, deviations + i + kHalf, l, codes.high, code_values.high);
  }
  const double ones = sum(codes);
  return {0, ones, ones, sum(code_values)};
}

WEIR_SIMD CodeSums assign(const float* values, const float* deviations, std::size_t count, const CodeLevels& levels) {
  const CodeLevels l = levels;
  Lanes codes;
  Lanes code_squares;
  Lanes code_values;
  for (std::size_t i = 0; i < count; i += 2 * kHalf) {
    Lanes v;
    load(values, i, count, l.minimum, v);
    assign_half(v.low, deviations + i, l, codes.low, code_squares.low, code_values.low);
    assign_half(v.high, deviations + i + kHalf, l, codes.high, code_squares.high, code_values.high);
  }
  return {0, sum(codes), sum(code_squares), sum(code_values)};
}

WEIR_SIMD double measure_squares(const float* values, std::size_t count, const CodeLevels& levels, float scale) {
  const CodeLevels l = levels;
  Lanes squares;
  for (std::size_t i = 0; i < count; i += 2 * kHalf) {
    Lanes v;
    load(values, i, count, l.minimum, v);
    measure_half(v.low, l, scale, squares.low);
    measure_half(v.high, l, scale, squares.high);
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
