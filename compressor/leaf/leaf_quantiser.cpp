#include "compressor/leaf/leaf_quantiser.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "compressor/leaf/code_sums.h"
#include "compressor/leaf/quantiser_fit.h"
#include "compressor/leaf/taken_codes.h"
#include "compressor/leaf/twin_sums.h"
#include "format/base/index.h"

namespace weir {
namespace {

using Deviations = std::array<float, kLeafVoxels>;

std::uint32_t most_code(unsigned bits) { return (1U << bits) - 1U; }

CodeLevels levels_of(const Quantiser& q) {
  return {q.minimum, q.quantum, q.quantum > 0 ? 1 / q.quantum : 0.0F, static_cast<float>(q.top)};
}

// Returns the level of a code, as a reader decodes it.
float level_of(std::uint32_t code, const Quantiser& q) {
  const float product = static_cast<float>(code) * q.quantum;
  return product + q.minimum;
}

// Returns the code of `v`, as nearest_codes() finds it.
std::uint32_t code_of(float v, const Quantiser& q, std::uint32_t most) {
  const float t = std::clamp((v - q.minimum) * (1 / q.quantum), 0.0F, static_cast<float>(most));
  return static_cast<std::uint32_t>((t + kRounder) - kRounder);
}

bool usable(const Quantiser& q) {
  return q.quantum >= kLeastQuantum && std::isfinite(q.quantum) && std::isfinite(q.minimum);
}

double width_of(const ValueRange& range) { return static_cast<double>(range.max) - static_cast<double>(range.min); }

// Returns whether no level lies below the range. If the least value is zero, the first level must be zero.
bool begins_inside(const Quantiser& q, const ValueRange& range) {
  return range.min == 0 ? q.minimum == 0 : q.minimum >= range.min;
}

// Returns the largest quantum (but for a rounding or two) for which level `code` does not lie above the range.
float quantum_up_to(std::uint32_t code, float minimum, const ValueRange& range) {
  const double width = static_cast<double>(range.max) - static_cast<double>(minimum);
  auto quantum = static_cast<float>(std::min(width, kWidest) / static_cast<double>(code));
  while (quantum > 0 && level_of(code, {minimum, quantum, 0}) > range.max) quantum = std::nextafter(quantum, 0.0F);
  return quantum;
}

// Returns the highest code that values take, lowered until its level does not lie above the range and code * quantum is
// a float.
std::uint32_t top_inside(const Quantiser& q, const ValueRange& range, std::uint32_t most) {
  const double width = static_cast<double>(range.max) - static_cast<double>(q.minimum);
  const double last = std::min(width, kWidest) / static_cast<double>(q.quantum) + 1;
  std::uint32_t code = code_of(range.max, q, most);
  if (last < static_cast<double>(code)) code = static_cast<std::uint32_t>(last);
  while (code > 0 && !(level_of(code, q) <= range.max)) --code;
  return code;
}

// Returns the quantiser for a range in which float has no two levels.
Quantiser one_level(const ValueRange& range) { return {range.min == 0 ? 0.0F : range.mean, 0, 0}; }

// Returns whether float has levels of `bits` bits for at least a part of the range.
bool divisible(const ValueRange& range, unsigned bits) {
  return width_of(range) > kWidest || range_quantiser(range, bits).quantum > 0;
}

// Fits quantisers to one leaf, one width after the other.
class Fitter {
 public:
  Fitter(std::span<const float> values, const ValueRange& range, const LeafRepeats& repeats)
      : values_(values), range_(range), repeats_(repeats) {
    const int exponent = -std::ilogb(range.max / 2 - range.min / 2);
    scale_ = std::ldexp(1.0F, exponent);
    unscale_ = std::ldexp(1.0, -exponent);
    deviation_ = range.deviation * static_cast<double>(scale_);
    squares_ = repeats.pairs_of_rows()
                   ? twin_deviate(values.data(), repeats.groups.slow, range.mean, scale_, deviations_.data())
                   : deviate(values.data(), values.size(), range.mean, scale_, deviations_.data());
  }

  void set_bits(unsigned bits) {
    bits_ = bits;
    most_ = most_code(bits);
    best_ = std::numeric_limits<double>::infinity();
  }

  // Refits from levels over `share` of the range. Keeps the best quantiser so far.
  void start(double share, int rounds) {
    const double width = width_of(range_);
    const double half = std::min(width * share, kWidest) / 2;
    const double middle = share == 1 ? static_cast<double>(range_.min) + width / 2 : static_cast<double>(range_.mean);
    Quantiser q{share == 1 && width <= kWidest ? range_.min : static_cast<float>(middle - half),
                static_cast<float>(2 * half / static_cast<double>(most_)), 0};
    if (!begins_inside(q, range_)) {
      q.minimum = range_.min;
      q.quantum = static_cast<float>((middle + half - static_cast<double>(range_.min)) / static_cast<double>(most_));
    }
    if (middle + half >= static_cast<double>(range_.max)) q.quantum = quantum_up_to(most_, q.minimum, range_);
    refine(q, rounds);
  }

  // Refits from the levels of `q`. Keeps the best quantiser so far.
  void refine(Quantiser q, int rounds) {
    double last = std::numeric_limits<double>::infinity();
    for (int round = 0; round < rounds && usable(q); ++round) {
      q.top = top_inside(q, range_, most_);
      const CodeSums sums = assigned(q);
      if (sums.squares < best_) {
        best_ = sums.squares;
        quantiser_ = q;
      }
      if (!(sums.squares < last)) return;  // Lloyd's iteration has converged up to rounding
      last = sums.squares;
      if (!refit(sums, q)) return;
    }
  }

  bool found() const { return best_ < std::numeric_limits<double>::infinity(); }
  Quantiser quantiser() const { return quantiser_; }
  double squared_error() const { return best_ * unscale_ * unscale_; }

 private:
  CodeSums assigned(const Quantiser& q) const {
    const CodeLevels levels = levels_of(q);
    CodeSums sums = repeats_.pairs_of_rows()
                        ? twin_assign(values_.data(), deviations_.data(), repeats_.groups.slow, levels)
                        : assign_all(levels);
    if (bits_ >= 8) {
      sums.squares = measured(levels);
      return sums;
    }
    sums.squares = followed(sums, q);
    // Such a small difference consists of the rounding errors of its two terms.
    if (!(sums.squares > kCancelled * squares_)) sums.squares = measured(levels);
    return sums;
  }

  CodeSums assign_all(const CodeLevels& levels) const {
    const bool one_bit = bits_ == 1 && std::isfinite(squares_);
    return (one_bit ? assign_bit : assign)(values_.data(), deviations_.data(), values_.size(), levels);
  }

  double measured(const CodeLevels& levels) const {
    return repeats_.pairs_of_rows() ? twin_measure(values_.data(), repeats_.groups.slow, levels, scale_)
                                    : measure_squares(values_.data(), values_.size(), levels, scale_);
  }

  // Returns the sum of (deviation - (code * quantum + minimum))^2 for the codes of `sums`, in multiplied-out form.
  double followed(const CodeSums& sums, const Quantiser& q) const {
    const double quantum = static_cast<double>(q.quantum) * static_cast<double>(scale_);
    const double minimum = scaled(q.minimum);
    const auto n = static_cast<double>(values_.size());
    return squares_ + quantum * (quantum * sums.code_squares - 2 * sums.code_values) +
           minimum * (n * minimum + 2 * (quantum * sums.codes - deviation_));
  }

  // Sets `q` to the least-squares fit of value = minimum + code * quantum with the first level in the range. Returns
  // false if all values have the same code.
  bool refit(const CodeSums& sums, Quantiser& q) const {
    const auto n = static_cast<double>(values_.size());
    const double determinant = n * sums.code_squares - sums.codes * sums.codes;
    if (!(determinant > 0)) return false;
    const double slope = (n * sums.code_values - sums.codes * deviation_) / determinant;
    q = from_mean((deviation_ - slope * sums.codes) / n, slope);
    if (!begins_inside(q, range_)) {
      const double least = scaled(range_.min);
      q = from_mean(least, (sums.code_values - least * sums.codes) / sums.code_squares);
      q.minimum = range_.min;
    }
    if (usable(q)) end_inside(sums, q);
    return true;
  }

  // If the level of the largest value lies above the range, that value must take the level below. Levels that end at
  // the largest value may have a smaller error; takes them if so.
  void end_inside(const CodeSums& sums, Quantiser& q) const {
    const std::uint32_t highest = code_of(range_.max, q, most_);
    if (highest == 0 || !(level_of(highest, q) > range_.max)) return;
    Quantiser ended = ending_at_largest(sums, highest);
    if (!begins_inside(ended, range_)) ended.minimum = range_.min;
    ended.quantum = std::min(ended.quantum, quantum_up_to(highest, ended.minimum, range_));
    const auto error = [&](std::uint32_t code) {
      return (static_cast<double>(range_.max) - static_cast<double>(level_of(code, q))) * static_cast<double>(scale_);
    };
    const double capped = error(highest - 1) * error(highest - 1) - error(highest) * error(highest);
    if (highest == 1 || followed(sums, ended) < followed(sums, q) + capped) q = ended;
  }

  // Returns the least-squares fit of value = largest - (code of the largest - code) * quantum.
  Quantiser ending_at_largest(const CodeSums& sums, std::uint32_t highest) const {
    const auto n = static_cast<double>(values_.size());
    const auto code = static_cast<double>(highest);
    const double largest = scaled(range_.max);
    const double steps = code * n - sums.codes;
    const double step_squares = code * (code * n - 2 * sums.codes) + sums.code_squares;
    const double step_values = code * deviation_ - sums.code_values;
    const double slope = (steps * largest - step_values) / step_squares;
    return from_mean(largest - code * slope, slope);
  }

  // Returns a value as a scaled deviation.
  double scaled(float value) const {
    return (static_cast<double>(value) - static_cast<double>(range_.mean)) * static_cast<double>(scale_);
  }
  // Returns the quantiser for levels that are given as scaled deviations.
  Quantiser from_mean(double minimum, double quantum) const {
    return {static_cast<float>(static_cast<double>(range_.mean) + minimum * unscale_),
            static_cast<float>(quantum * unscale_), 0};
  }

  std::span<const float> values_;
  ValueRange range_;
  LeafRepeats repeats_;
  Deviations deviations_;  // scaled; as many as there are values
  float scale_;
  double unscale_;
  double deviation_;  // sum of the deviations, which is not 0 because the mean is rounded
  double squares_;    // sum of the squared deviations
  unsigned bits_ = 0;
  std::uint32_t most_ = 0;  // 2^bits - 1
  double best_ = 0;         // squared error, scaled
  Quantiser quantiser_;
};

// Returns whether levels of half the bits may fit better than `quantiser` does with `bits`. Values for which they do
// lie so near to the levels of half the bits that hardly any of these levels has more than three codes of `bits` on it.
// A code with only a few values does not count. At 16 bits a leaf has too few values to tell.
bool may_fit_half(std::span<const float> values, const Quantiser& quantiser, unsigned bits,
                  const LeafRepeats& repeats) {
  if (bits == 16) return true;
  std::array<float, kLeafVoxels> distinct;
  std::span<const float> seen = values;
  if (repeats.pairs_of_rows())
    seen = std::span(distinct).first(take_distinct(values.data(), repeats.groups, distinct.data()));
  std::array<std::uint16_t, kLeafVoxels> all;
  const std::span<std::uint16_t> codes = std::span(all).first(seen.size());
  quantise(seen, quantiser, codes);
  // An eighth of the values that each code would have if all codes were taken equally often.
  const auto few = static_cast<unsigned>((values.size() >> (bits + 3)) / repeats.times());
  return taken_codes(codes, bits, few) <= (bits == 8 ? 64 : bits == 4 ? 12 : 3);
}

}  // namespace

Quantiser range_quantiser(const ValueRange& range, unsigned bits) {
  const std::uint32_t most = most_code(bits);
  if (width_of(range) > kWidest) return one_level(range);
  const Quantiser q{range.min, quantum_up_to(most, range.min, range), most};
  return usable(q) ? q : one_level(range);
}

Quantiser fit_quantiser(std::span<const float> values, const ValueRange& range, unsigned bits,
                        const LeafRepeats& repeats) {
  // Levels of fewer bits are also levels of more bits.
  if (!divisible(range, bits)) return bits == 1 ? one_level(range) : fit_quantiser(values, range, bits / 2, repeats);
  Fitter fitter(values, range, repeats);
  const auto fit = [&](unsigned width) {
    fitter.set_bits(width);
    fitter.start(1, width <= 4 ? 3 : 2);
    if (width <= 2) fitter.start(0.45, 3);
    return fitter.found() ? fitter.quantiser() : one_level(range);
  };
  std::array<Quantiser, 5> tried{fit(bits)};  // each with half the bits of the previous one
  std::size_t count = 1;
  for (unsigned width = bits; width > 1 && may_fit_half(values, tried[count - 1], width, repeats); width /= 2) {
    tried[count++] = fit(width / 2);
  }
  if (count == 1) return tried[0];
  fitter.set_bits(bits);
  fitter.refine(tried[0], 1);
  for (const Quantiser& levels : std::span(tried).subspan(1, count - 1)) fitter.refine(levels, 2);
  return fitter.found() ? fitter.quantiser() : tried[0];
}

std::array<double, 3> estimated_errors(std::span<const float> values, const ValueRange& range, unsigned below_bits,
                                       double squares, const LeafRepeats& repeats) {
  std::array<double, 3> errors{1, 1, 1};
  if (below_bits <= 1 || !divisible(range, 1)) return errors;
  Fitter fitter(values, range, repeats);
  for (unsigned log2 = 0; log2 < errors.size() && 1U << log2 < below_bits; ++log2) {
    if (!divisible(range, 1U << log2)) continue;
    fitter.set_bits(1U << log2);
    const EstimateStart& start = kEstimateStarts[log2];
    fitter.start(start.share, start.rounds);
    if (fitter.found()) errors[log2] = std::min(1.0, start.gain * fitter.squared_error() / squares);
  }
  return errors;
}

void quantise(std::span<const float> values, const Quantiser& quantiser, std::span<std::uint16_t> codes) {
  nearest_codes(values.data(), values.size(), levels_of(quantiser), codes.data());
}

}  // namespace weir
