#include "compressor/leaf_quantiser.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "format/simd.h"

namespace weir {
namespace {

constexpr std::size_t kLanes = 16;
/// Added and taken away again, it rounds a float below 2^22 to the nearest whole number, ties to even.
constexpr float kRounder = 12582912.0F;  // 1.5 * 2^23
/// Quanta below this have no reciprocal.
constexpr float kLeastQuantum = 0x1p-120F;

// What one assignment of values to levels comes to. Deviations are from the leaf's mean, times `scale`, a power of
// two that brings them near 1, so that neither 1e-16 nor 1e+30 squared leaves the range of float.
struct Sums {
  float squares = 0;  // of the scaled errors
  float codes = 0;    // exact: below 2^24 a lane for up to 8 bits
  float code_squares = 0;
  float code_values = 0;  // code * scaled deviation
};

struct Levels {
  float minimum;
  float quantum;
  float reciprocal;
  float top;
  float mean;
  float scale;
};

// Pairwise, whatever the machine.
float sum(const Floats16& lanes) {
  std::array<float, kLanes> all;
  std::memcpy(all.data(), &lanes, sizeof all);
  for (std::size_t width = kLanes / 2; width > 0; width /= 2) {
    for (std::size_t i = 0; i < width; ++i) all[i] += all[i + width];
  }
  return all[0];
}

WEIR_SIMD Sums assign(const float* values, std::size_t count, const Levels& levels) {
  const Levels l = levels;
  const Floats16 zero{};
  const Floats16 top = l.top - zero;
  Floats16 squares{};
  Floats16 codes{};
  Floats16 code_squares{};
  Floats16 code_values{};
  for (std::size_t i = 0; i < count; i += kLanes) {
    const float* from = values + i;
    std::array<float, kLanes> rest;
    if (count - i < kLanes) {
      rest.fill(l.minimum);  // code 0 without error: adds nothing
      std::memcpy(rest.data(), from, (count - i) * sizeof(float));
      from = rest.data();
    }
    Floats16 v;
    std::memcpy(&v, from, sizeof v);
    Floats16 t = (v - l.minimum) * l.reciprocal;
    t = t > zero ? t : zero;
    t = t < top ? t : top;
    const Floats16 code = (t + kRounder) - kRounder;
    const Floats16 error = (v - (code * l.quantum + l.minimum)) * l.scale;
    squares += error * error;
    codes += code;
    code_squares += code * code;
    code_values += code * ((v - l.mean) * l.scale);
  }
  return {sum(squares), sum(codes), sum(code_squares), sum(code_values)};
}

WEIR_SIMD void nearest_codes(const float* values, std::size_t count, const Levels& levels, std::uint16_t* codes) {
  const Levels l = levels;
  for (std::size_t i = 0; i < count; ++i) {
    float t = (values[i] - l.minimum) * l.reciprocal;
    t = t > 0.0F ? t : 0.0F;
    t = t < l.top ? t : l.top;
    codes[i] = static_cast<std::uint16_t>(static_cast<std::int32_t>((t + kRounder) - kRounder));
  }
}

float top_code(unsigned bits) { return static_cast<float>((1U << bits) - 1U); }

bool usable(const Quantiser& q, float top) {
  return q.quantum >= kLeastQuantum && std::isfinite(q.minimum) && std::isfinite(q.quantum * top) &&
         std::isfinite(q.quantum * top + q.minimum);
}

// One leaf being fitted.
class Fitter {
 public:
  Fitter(std::span<const float> values, const ValueRange& range, unsigned bits)
      : values_(values), range_(range), top_(top_code(bits)) {
    const float half = range.max / 2 - range.min / 2;
    scale_exponent_ = -std::ilogb(half);
    scale_ = std::ldexp(1.0F, scale_exponent_);
    deviation_ = std::ldexp(range.deviation, scale_exponent_);
  }

  // Refits from levels over `share` of the range; keeps what is better than before.
  void start(double share, int rounds) {
    const double half = (static_cast<double>(range_.max) - static_cast<double>(range_.min)) / 2 * share;
    const double middle = share == 1 ? static_cast<double>(range_.min) + half : static_cast<double>(range_.mean);
    Quantiser q{share == 1 ? range_.min : static_cast<float>(middle - half),
                static_cast<float>(2 * half / static_cast<double>(top_))};
    float last = std::numeric_limits<float>::infinity();
    for (int round = 0; round < rounds && usable(q, top_); ++round) {
      const Sums sums =
          assign(values_.data(), values_.size(), {q.minimum, q.quantum, 1 / q.quantum, top_, range_.mean, scale_});
      if (sums.squares < best_) {
        best_ = sums.squares;
        fit_.quantiser = q;
      }
      if (!(sums.squares < last)) return;  // Lloyd's iteration has converged, but for roundings
      last = sums.squares;
      if (!refit(sums, q)) return;
    }
  }

  QuantiserFit result() {
    fit_.squared_error = std::ldexp(static_cast<double>(best_), -2 * scale_exponent_);
    return fit_;
  }
  bool found() const { return best_ < std::numeric_limits<float>::infinity(); }

 private:
  // Least squares of value = minimum + code * quantum; false where all values have one code.
  bool refit(const Sums& sums, Quantiser& q) const {
    const auto n = static_cast<double>(values_.size());
    const auto codes = static_cast<double>(sums.codes);
    const double determinant = n * static_cast<double>(sums.code_squares) - codes * codes;
    if (!(determinant > 0)) return false;
    const double slope = (n * static_cast<double>(sums.code_values) - codes * deviation_) / determinant;
    const double offset = (deviation_ - slope * codes) / n;
    q.quantum = static_cast<float>(std::ldexp(slope, -scale_exponent_));
    q.minimum = static_cast<float>(static_cast<double>(range_.mean) + std::ldexp(offset, -scale_exponent_));
    return true;
  }

  std::span<const float> values_;
  ValueRange range_;
  float top_;
  int scale_exponent_;
  float scale_;
  double deviation_;  // sum of the scaled deviations from the mean
  float best_ = std::numeric_limits<float>::infinity();
  QuantiserFit fit_;
};

double squares_about(std::span<const float> values, float level) {
  double total = 0;
  for (const float v : values) {
    const double d = static_cast<double>(v) - static_cast<double>(level);
    total += d * d;
  }
  return total;
}

}  // namespace

Quantiser range_quantiser(const ValueRange& range, unsigned bits) {
  const float top = top_code(bits);
  const double width = static_cast<double>(range.max) - static_cast<double>(range.min);
  const Quantiser q{range.min, static_cast<float>(width / static_cast<double>(top))};
  return usable(q, top) ? q : Quantiser{range.mean, 0};
}

QuantiserFit fit_quantiser(std::span<const float> values, const ValueRange& range, unsigned bits) {
  if (range_quantiser(range, bits).quantum > 0) {
    Fitter fitter(values, range, bits);
    fitter.start(1, bits <= 4 ? 3 : 2);
    if (bits <= 2) fitter.start(0.45, 3);
    if (fitter.found()) return fitter.result();
  }
  return {{range.mean, 0}, squares_about(values, range.mean)};
}

double estimated_error(std::span<const float> values, const ValueRange& range, unsigned bits, double squares) {
  if (!(range_quantiser(range, bits).quantum > 0)) return 1;
  Fitter fitter(values, range, bits);
  // What the rounds left out would gain on average: 0.5 dB at 2 bits, 0.3 dB at 4.
  double gain = 1;
  switch (bits) {
    case 1:
      fitter.start(0.7, 2);
      gain = 0.93;
      break;
    case 2:
      fitter.start(1, 3);
      gain = 0.89;
      break;
    default:
      fitter.start(1, 1);
      gain = 0.93;
  }
  return fitter.found() ? std::min(1.0, gain * fitter.result().squared_error / squares) : 1;
}

void quantise(std::span<const float> values, const Quantiser& quantiser, unsigned bits,
              std::span<std::uint16_t> codes) {
  const float reciprocal = quantiser.quantum > 0 ? 1 / quantiser.quantum : 0.0F;
  nearest_codes(values.data(), values.size(), {quantiser.minimum, quantiser.quantum, reciprocal, top_code(bits), 0, 1},
                codes.data());
}

}  // namespace weir
