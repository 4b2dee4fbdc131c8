// Compares the quantiser's kernels bit for bit with the same arithmetic written out one value at a time, for whichever
// instruction set is picked at run time.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "compressor/leaf/leaf_lattice.h"
#include "compressor/leaf/leaf_quantiser.h"

namespace weir::quantised_reference_test {
namespace {

constexpr std::size_t kLanes = 16;

// Lane l sums the values l, l + 16, ... Then the lanes are added in halves.
class LaneSum {
 public:
  void add(std::size_t i, float term) { lanes_[i % kLanes] += term; }
  float value() const {
    std::array<float, kLanes> sums = lanes_;
    for (std::size_t width = kLanes / 2; width > 0; width /= 2) {
      for (std::size_t l = 0; l < width; ++l) sums[l] = sums[l] + sums[l + width];
    }
    return sums[0];
  }

 private:
  std::array<float, kLanes> lanes_{};
};

float nearest_code(float value, const Quantiser& q) {
  const auto top = static_cast<float>(q.top);
  const float reciprocal = q.quantum > 0 ? 1 / q.quantum : 0.0F;
  float t = (value - q.minimum) * reciprocal;
  t = t > 0 ? t : 0.0F;
  t = t < top ? t : top;
  return std::nearbyint(t);
}

// Returns the code of the level nearest to the largest value, even if this level lies above that value.
std::uint32_t nearest_to_largest(const ValueRange& range, Quantiser q, unsigned bits) {
  q.top = (1U << bits) - 1U;
  return static_cast<std::uint32_t>(nearest_code(range.max, q));
}

float level(std::uint32_t code, const Quantiser& q) {
  const float product = static_cast<float>(code) * q.quantum;
  return product + q.minimum;
}

bool below(const Quantiser& q, const ValueRange& range) {
  return range.min == 0 ? q.minimum != 0 : q.minimum < range.min;
}

// Returns the largest quantum that keeps level `code` inside the range, by stepping down from the quotient.
float ending_quantum(std::uint32_t code, float minimum, const ValueRange& range) {
  auto quantum = static_cast<float>((static_cast<double>(range.max) - static_cast<double>(minimum)) / code);
  while (quantum > 0 && level(code, {minimum, quantum, 0}) > range.max) quantum = std::nextafter(quantum, 0.0F);
  return quantum;
}

class Reference {
 public:
  Reference(const std::vector<float>& values, const ValueRange& range, unsigned bits)
      : values_(values), range_(range), bits_(bits), most_((1U << bits) - 1U) {
    const int exponent = -std::ilogb(range.max / 2 - range.min / 2);
    scale_ = std::ldexp(1.0F, exponent);
    unscale_ = std::ldexp(1.0, -exponent);
    deviation_ = std::ldexp(range.deviation, exponent);
    LaneSum squares;
    for (std::size_t i = 0; i < values_.size(); ++i) squares.add(i, deviation(i) * deviation(i));
    squares_ = static_cast<double>(squares.value());
  }

  void start(double share, int rounds) {
    const double half = (static_cast<double>(range_.max) - static_cast<double>(range_.min)) / 2 * share;
    const double middle = static_cast<double>(share == 1 ? range_.min : range_.mean) + (share == 1 ? half : 0);
    Quantiser q{share == 1 ? range_.min : static_cast<float>(middle - half), static_cast<float>(2 * half / most_), 0};
    if (below(q, range_)) {
      q.minimum = range_.min;
      q.quantum = static_cast<float>((middle + half - static_cast<double>(range_.min)) / most_);
    }
    if (middle + half >= static_cast<double>(range_.max)) q.quantum = ending_quantum(most_, q.minimum, range_);
    refine(q, rounds);
  }

  void refine(Quantiser q, int rounds) {
    double last = std::numeric_limits<double>::infinity();
    for (int round = 0; round < rounds; ++round) {
      if (!usable(q)) return;
      q.top = nearest_to_largest(range_, q, bits_);
      while (q.top > 0 && !(level(q.top, q) <= range_.max)) --q.top;
      LaneSum measured;
      LaneSum codes;
      LaneSum code_squares;
      LaneSum code_values;
      for (std::size_t i = 0; i < values_.size(); ++i) {
        const float code = nearest_code(values_[i], q);
        const float product = code * q.quantum;
        const float error = (values_[i] - (product + q.minimum)) * scale_;
        measured.add(i, error * error);
        codes.add(i, code);
        code_squares.add(i, code * code);
        code_values.add(i, code * deviation(i));
      }
      const Sums sums{static_cast<double>(codes.value()), static_cast<double>(code_squares.value()),
                      static_cast<double>(code_values.value())};
      const double squares = bits_ >= 8 || !(followed(sums, q) > 1e-4 * squares_)
                                 ? static_cast<double>(measured.value())
                                 : followed(sums, q);
      if (squares < best_) {
        best_ = squares;
        fit = q;
      }
      if (!(squares < last)) return;
      last = squares;
      if (!refit(sums, q)) return;
    }
  }

  Quantiser fit;

 private:
  struct Sums {
    double c;   // sum of codes
    double cc;  // sum of squared codes
    double cv;  // sum of codes times deviations
  };

  bool usable(const Quantiser& q) const { return q.quantum >= 0x1p-120F && std::isfinite(q.minimum); }

  double followed(const Sums& s, const Quantiser& q) const {
    const auto n = static_cast<double>(values_.size());
    const double quantum = static_cast<double>(q.quantum) * static_cast<double>(scale_);
    const double minimum = scaled(q.minimum);
    return squares_ + quantum * (quantum * s.cc - 2 * s.cv) +
           minimum * (n * minimum + 2 * (quantum * s.c - deviation_));
  }

  // Sets `q` to the least-squares fit of value = minimum + code * quantum with no level below the range.
  bool refit(const Sums& s, Quantiser& q) const {
    const auto n = static_cast<double>(values_.size());
    const double determinant = n * s.cc - s.c * s.c;
    if (!(determinant > 0)) return false;
    const double slope = (n * s.cv - s.c * deviation_) / determinant;
    q.quantum = static_cast<float>(slope * unscale_);
    q.minimum = from_mean((deviation_ - slope * s.c) / n);
    if (below(q, range_)) {
      q.quantum = static_cast<float>((s.cv - scaled(range_.min) * s.c) / s.cc * unscale_);
      q.minimum = range_.min;
    }
    if (!usable(q)) return true;
    // Either the level above the largest value is not taken, or the levels end at the largest value.
    const std::uint32_t highest = nearest_to_largest(range_, q, bits_);
    if (highest == 0 || level(highest, q) <= range_.max) return true;
    const double h = highest;
    const double largest = scaled(range_.max);
    const double quantum = ((h * n - s.c) * largest - (h * deviation_ - s.cv)) / (h * (h * n - 2 * s.c) + s.cc);
    Quantiser ended{from_mean(largest - h * quantum), static_cast<float>(quantum * unscale_), 0};
    if (below(ended, range_)) ended.minimum = range_.min;
    ended.quantum = std::min(ended.quantum, ending_quantum(highest, ended.minimum, range_));
    const double above = (static_cast<double>(range_.max) - static_cast<double>(level(highest, q))) * scale_;
    const double under = (static_cast<double>(range_.max) - static_cast<double>(level(highest - 1, q))) * scale_;
    if (highest == 1 || followed(s, ended) < followed(s, q) + (under * under - above * above)) q = ended;
    return true;
  }

  double scaled(float value) const {
    return (static_cast<double>(value) - static_cast<double>(range_.mean)) * static_cast<double>(scale_);
  }
  float from_mean(double v) const { return static_cast<float>(static_cast<double>(range_.mean) + v * unscale_); }
  float deviation(std::size_t i) const { return (values_[i] - range_.mean) * scale_; }

  const std::vector<float>& values_;
  ValueRange range_;
  unsigned bits_;
  std::uint32_t most_;
  float scale_;
  double unscale_;
  double deviation_;
  double squares_ = 0;
  double best_ = std::numeric_limits<double>::infinity();
};

Quantiser reference_over_range(const std::vector<float>& values, const ValueRange& range, unsigned bits) {
  Reference reference(values, range, bits);
  reference.start(1, bits <= 4 ? 3 : 2);
  if (bits <= 2) reference.start(0.45, 3);
  return reference.fit;
}

// If the values take few levels, also tries the levels of half the bits, and so on.
Quantiser reference_fit(const std::vector<float>& values, const ValueRange& range, unsigned bits) {
  std::vector<Quantiser> tried{reference_over_range(values, range, bits)};
  for (unsigned width = bits; width > 1; width /= 2) {
    std::map<float, std::size_t> taken;
    for (const float v : values) ++taken[nearest_code(v, tried.back())];
    const std::size_t beside = values.size() / 8 / (std::size_t{1} << width);
    const auto levels =
        std::count_if(taken.begin(), taken.end(), [&](const auto& code) { return code.second > beside; });
    const std::map<unsigned, std::ptrdiff_t> few{{16, 512}, {8, 64}, {4, 12}, {2, 3}};
    if (levels > few.at(width)) break;
    tried.push_back(reference_over_range(values, range, width / 2));
  }
  if (tried.size() == 1) return tried[0];
  Reference best(values, range, bits);
  for (std::size_t i = 0; i < tried.size(); ++i) best.refine(tried[i], i == 0 ? 1 : 2);
  return best.fit;
}

std::vector<float> leaf(std::mt19937& random, int kind) {
  static constexpr std::array<std::size_t, 8> kCounts{512, 512, 512, 511, 64, 17, 16, 2};
  std::vector<float> values(kCounts[random() % kCounts.size()]);
  const float scale = std::ldexp(1.0F, static_cast<int>(random() % 200) - 100);
  const float offset = kind % 2 == 0 ? 0.0F : scale * static_cast<float>(random() % 1000);
  for (float& v : values) {
    const float u = static_cast<float>(random() >> 8U) * 0x1p-24F - 0.5F;
    switch (kind / 2) {
      case 0:
        v = offset + scale * u;
        break;
      case 1:  // peaked around 0
        v = offset + scale * u * u * u;
        break;
      case 2:  // mostly one value
        v = offset + (random() % 16 == 0 ? scale * u : 0.0F);
        break;
      default:  // on a lattice of about 100 levels
        v = offset + scale * std::nearbyint(u * 100);
    }
  }
  values[0] = offset - scale;  // never all equal
  return values;
}

ValueRange range_of(const std::vector<float>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  double sum = 0;
  for (const float v : values) sum += static_cast<double>(v);
  const auto count = static_cast<double>(values.size());
  const auto mean = static_cast<float>(sum / count);
  return {*low, *high, mean, sum - count * static_cast<double>(mean)};
}

std::uint32_t bits_of(float v) { return std::bit_cast<std::uint32_t>(v); }

TEST(QuantisedReference, FitsAndCodesHaveTheSameBits) {
  std::mt19937 random(11);
  for (int round = 0; round < 2000; ++round) {
    const std::vector<float> values = leaf(random, round % 8);
    const ValueRange range = range_of(values);
    if (!(range.min < range.max)) continue;
    for (const unsigned bits : {1U, 2U, 4U, 8U, 16U}) {
      SCOPED_TRACE("leaf " + std::to_string(round) + ", bits " + std::to_string(bits));
      const Quantiser reference = reference_fit(values, range, bits);
      const Quantiser fit = fit_quantiser(values, range, bits);
      if (!(range_quantiser(range, bits).quantum > 0)) {
        EXPECT_EQ(fit.quantum, 0.0F);
        continue;
      }
      ASSERT_EQ(bits_of(fit.minimum), bits_of(reference.minimum));
      ASSERT_EQ(bits_of(fit.quantum), bits_of(reference.quantum));
      ASSERT_EQ(fit.top, reference.top);
      std::vector<std::uint16_t> codes(values.size());
      quantise(values, fit, codes);
      for (std::size_t i = 0; i < values.size(); ++i) {
        ASSERT_EQ(static_cast<float>(codes[i]), nearest_code(values[i], fit));
      }
    }
  }
}

// Finds the coarsest lattice by exact arithmetic: doubles hold multiples of the smallest unit of values of one
// magnitude.
std::optional<LeafLattice> reference_lattice(const std::vector<float>& values, const ValueRange& range) {
  const float magnitude = std::max(std::fabs(range.min), std::fabs(range.max));
  const double unit = std::ldexp(1.0, std::ilogb(magnitude) - 23);
  std::int64_t step = 0;
  for (const float v : values) {
    const double scaled = static_cast<double>(v) / unit;
    if (scaled != std::nearbyint(scaled) || bits_of(v) == 0x80000000U) return std::nullopt;
    step = std::gcd(step, std::llround(scaled) - std::llround(static_cast<double>(range.min) / unit));
  }
  const double width = (static_cast<double>(range.max) - static_cast<double>(range.min)) / unit;
  const std::int64_t power = step & -step;  // the largest power of two that divides the step
  if (width / static_cast<double>(power) >= 0x1p24 || width / static_cast<double>(step) > 65535) return std::nullopt;
  return LeafLattice{static_cast<float>(static_cast<double>(step) * unit),
                     static_cast<std::uint32_t>(std::llround(width) / step)};
}

TEST(QuantisedReference, LatticesAreThoseOfExactArithmetic) {
  std::mt19937 random(12);
  int found = 0;
  for (int round = 0; round < 4000; ++round) {
    std::vector<float> values = leaf(random, round % 8);
    if (round % 3 == 0) values.resize(2 + random() % 8);
    const ValueRange range = range_of(values);
    const float magnitude = std::max(std::fabs(range.min), std::fabs(range.max));
    if (!(range.min < range.max) || magnitude < 0x1p-99F || magnitude > 0x1p99F) continue;
    const auto expected = reference_lattice(values, range);
    const auto lattice = find_lattice(values, range.min, range.max);
    ASSERT_EQ(lattice.has_value(), expected.has_value()) << round;
    if (!lattice) continue;
    ++found;
    ASSERT_EQ(bits_of(lattice->step), bits_of(expected->step)) << round;
    ASSERT_EQ(lattice->largest, expected->largest) << round;
  }
  EXPECT_GT(found, 500);
}

}  // namespace
}  // namespace weir::quantised_reference_test
