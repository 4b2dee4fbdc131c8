// Fits quantisers to eight leaves at once that repeat their values, one leaf per lane. Does what Fitter in
// leaf_quantiser.cpp does, operation by operation. The results of lanes that are done are computed but ignored.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <limits>

#include "compressor/leaf/code_levels.h"
#include "compressor/leaf/lanes/lane_masks.h"
#include "compressor/leaf/lanes/lane_ranges.h"
#include "compressor/leaf/lanes/lane_shape.h"
#include "compressor/leaf/lanes/lane_sums.h"
#include "compressor/leaf/quantiser_fit.h"

namespace weir {

struct LaneQuantisers {
  Floats8 minimum;
  Floats8 quantum;
  Floats8 top;
};

/// The CodeSums of each lane.
struct LaneCodeSums {
  Doubles8 squares;
  Doubles8 codes;
  Doubles8 code_squares;
  Doubles8 code_values;
};

/// Only functions with WEIR_SIMD may use this class. All of its code is inlined into them.
class LaneFitter {
 public:
  /// `values` has one value of each group, x fastest.
  [[gnu::always_inline]] LaneFitter(const Floats8* values, const LaneShape& shape, const LaneRanges& ranges)
      : values_(values), shape_(shape), count_(shape.values()), times_(static_cast<double>(shape.times())), r_(ranges) {
    least_ = Doubles8(r_.min);
    most_value_ = Doubles8(r_.max);
    mean_ = Doubles8(r_.mean);
    const Floats8 half = r_.max / 2.0F - r_.min / 2.0F;
    for (std::size_t l = 0; l < kLeafLanes; ++l) {  // `half` is a normal number, so its bits hold its exponent
      const float of_lane = half[static_cast<int>(l)];
      std::uint32_t bits;
      std::memcpy(&bits, &of_lane, sizeof bits);
      const int exponent = static_cast<int>(bits >> 23U & 0xFFU) - 127;
      const std::uint32_t power = static_cast<std::uint32_t>(127 - exponent) << 23U;
      float scale;
      std::memcpy(&scale, &power, sizeof scale);
      scale_[static_cast<int>(l)] = scale;
    }
    wide_scale_ = Doubles8(scale_);
    unscale_ = 1.0 / wide_scale_;  // powers of two
    deviation_ = Doubles8(r_.residual) * wide_scale_;
    for (std::size_t i = 0; i < count_; ++i) {
      deviations_[i] = (values_[i] - r_.mean) * scale_;
      terms_[i] = deviations_[i] * deviations_[i];
    }
    sum_terms(squares_);
  }

  /// Fits levels with codes up to `most`, beginning with levels over `share` of the range. Sets the least squared error
  /// of `rounds` rounds; infinite if there is none.
  [[gnu::always_inline]] void start(double share, int rounds, float most, Doubles8& squared_error) {
    most_ = most - Floats8{};
    const Doubles8 wide_most(static_cast<double>(most));
    const Doubles8 width = most_value_ - least_;
    const Doubles8 part = width * share;
    const Doubles8 half = at_most(part, kWidest) / 2.0;
    const bool all = share == 1;
    const Doubles8 middle = all ? least_ + width / 2.0 : mean_;
    LaneQuantisers q;
    q.minimum = r_.min;
    if (!all) narrow(middle - half, q.minimum);
    narrow(2.0 * half / wide_most, q.quantum);
    Ints8 outside;
    begins_outside(q.minimum, outside);
    Floats8 from_least;
    narrow((middle + half - least_) / wide_most, from_least);
    q.quantum = outside ? from_least : q.quantum;
    q.minimum = outside ? r_.min : q.minimum;
    Ints8 to_end;
    narrow(middle + half >= most_value_, to_end);
    Floats8 ended;
    quantum_up_to(most_, q.minimum, to_end, ended);
    q.quantum = to_end ? ended : q.quantum;
    best_ = kInfinity;
    refine(q, rounds);
    squared_error = best_ * unscale_ * unscale_;
  }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr auto kVoxels = static_cast<double>(kLeafVoxels);

  // Returns `v`, but `most` in the lanes that have more.
  [[gnu::always_inline]] static Doubles8 at_most(const Doubles8& v, const Doubles8& most) {
    return select(most < v, most, v);
  }

  [[gnu::always_inline]] void refine(LaneQuantisers& q, int rounds) {
    Doubles8 last = kInfinity;
    Ints8 active = ~Ints8{};
    for (int round = 0;; ++round) {
      Ints8 able;
      usable(q, able);
      active &= able;
      if (!any_lane(active)) return;
      top_inside(q, active);
      LaneCodeSums sums;
      assign(q, active, sums);
      best_ = select(widen(active) & (sums.squares < best_), sums.squares, best_);
      if (round + 1 == rounds) return;
      Ints8 goes_on;
      narrow(sums.squares < last, goes_on);
      active &= goes_on;
      last = sums.squares;
      refit(sums, active, q);
    }
  }

  [[gnu::always_inline]] void assign(const LaneQuantisers& q, const Ints8& active, LaneCodeSums& sums) {
    const Floats8 zero{};
    const Floats8 reciprocal = q.quantum > zero ? 1.0F / q.quantum : zero;
    Floats8 codes{};
    Floats8 code_squares{};
    for (std::size_t i = 0; i < count_; ++i) {
      Floats8 code;
      nearest(values_[i], q, reciprocal, code);
      codes += code;
      code_squares += code * code;
      terms_[i] = code * deviations_[i];
    }
    // The sums are whole numbers below 2^24, so they are exact in any order.
    sums.codes = Doubles8(codes) * times_;
    sums.code_squares = Doubles8(code_squares) * times_;
    sum_terms(sums.code_values);
    follow(sums, q, sums.squares);
    Ints8 cancelled;
    narrow(~(sums.squares > kCancelled * squares_), cancelled);
    cancelled &= active;
    if (!any_lane(cancelled)) return;
    for (std::size_t i = 0; i < count_; ++i) {
      Floats8 code;
      nearest(values_[i], q, reciprocal, code);
      const Floats8 error = (values_[i] - (code * q.quantum + q.minimum)) * scale_;
      terms_[i] = error * error;
    }
    Doubles8 measured;
    sum_terms(measured);
    sums.squares = select(widen(cancelled), measured, sums.squares);
  }

  [[gnu::always_inline]] void refit(const LaneCodeSums& sums, Ints8& active, LaneQuantisers& q) const {
    const Doubles8 determinant = kVoxels * sums.code_squares - sums.codes * sums.codes;
    Ints8 several;
    narrow(determinant > 0.0, several);
    active &= several;
    const Doubles8 slope = (kVoxels * sums.code_values - sums.codes * deviation_) / determinant;
    from_mean((deviation_ - slope * sums.codes) / kVoxels, slope, q);
    Ints8 outside;
    begins_outside(q.minimum, outside);
    if (any_lane(outside & active)) {
      Doubles8 least;
      scaled(r_.min, least);
      LaneQuantisers from_least;
      from_mean(least, (sums.code_values - least * sums.codes) / sums.code_squares, from_least);
      q.quantum = outside ? from_least.quantum : q.quantum;
      q.minimum = outside ? r_.min : q.minimum;
    }
    Ints8 able;
    usable(q, able);
    end_inside(sums, active & able, q);
  }

  [[gnu::always_inline]] void end_inside(const LaneCodeSums& sums, const Ints8& active, LaneQuantisers& q) const {
    Floats8 highest;
    code_of_largest(q, highest);
    const Floats8 zero{};
    const Ints8 beyond = active & (highest != zero) & (highest * q.quantum + q.minimum > r_.max);
    if (!any_lane(beyond)) return;
    LaneQuantisers ended;
    end_at_largest(sums, highest, ended);
    Ints8 outside;
    begins_outside(ended.minimum, outside);
    ended.minimum = outside ? r_.min : ended.minimum;
    Floats8 most_quantum;
    quantum_up_to(highest, ended.minimum, beyond, most_quantum);
    ended.quantum = most_quantum < ended.quantum ? most_quantum : ended.quantum;
    Doubles8 error_below;
    Doubles8 error_at;
    error_of_largest(highest - 1.0F, q, error_below);
    error_of_largest(highest, q, error_at);
    const Doubles8 capped = error_below * error_below - error_at * error_at;
    Doubles8 of_ended;
    Doubles8 of_q;
    follow(sums, ended, of_ended);
    follow(sums, q, of_q);
    Ints8 better;
    narrow(of_ended < of_q + capped, better);
    const Ints8 taken = beyond & (better | (highest == 1.0F));
    q.minimum = taken ? ended.minimum : q.minimum;
    q.quantum = taken ? ended.quantum : q.quantum;
  }

  [[gnu::always_inline]] void end_at_largest(const LaneCodeSums& sums, const Floats8& highest,
                                             LaneQuantisers& q) const {
    const Doubles8 code = Doubles8(highest);
    Doubles8 largest;
    scaled(r_.max, largest);
    const Doubles8 steps = code * kVoxels - sums.codes;
    const Doubles8 step_squares = code * (code * kVoxels - 2.0 * sums.codes) + sums.code_squares;
    const Doubles8 step_values = code * deviation_ - sums.code_values;
    const Doubles8 slope = (steps * largest - step_values) / step_squares;
    from_mean(largest - code * slope, slope, q);
  }

  [[gnu::always_inline]] void error_of_largest(const Floats8& code, const LaneQuantisers& q, Doubles8& error) const {
    const Floats8 level = code * q.quantum + q.minimum;
    error = (most_value_ - Doubles8(level)) * wide_scale_;
  }

  [[gnu::always_inline]] void follow(const LaneCodeSums& sums, const LaneQuantisers& q, Doubles8& squares) const {
    const Doubles8 quantum = Doubles8(q.quantum) * wide_scale_;
    Doubles8 minimum;
    scaled(q.minimum, minimum);
    squares = squares_ + quantum * (quantum * sums.code_squares - 2.0 * sums.code_values) +
              minimum * (kVoxels * minimum + 2.0 * (quantum * sums.codes - deviation_));
  }

  [[gnu::always_inline]] void nearest(const Floats8& v, const LaneQuantisers& q, const Floats8& reciprocal,
                                      Floats8& code) const {
    const Floats8 zero{};
    Floats8 t = (v - q.minimum) * reciprocal;
    t = t > zero ? t : zero;
    t = t < q.top ? t : q.top;
    code = (t + kRounder) - kRounder;
  }

  [[gnu::always_inline]] void code_of_largest(const LaneQuantisers& q, Floats8& code) const {
    const Floats8 zero{};
    Floats8 t = (r_.max - q.minimum) * (1.0F / q.quantum);
    t = t < zero ? zero : t;
    t = most_ < t ? most_ : t;
    code = (t + kRounder) - kRounder;
  }

  [[gnu::always_inline]] void top_inside(LaneQuantisers& q, const Ints8& active) const {
    const Doubles8 last = at_most(most_value_ - Doubles8(q.minimum), kWidest) / Doubles8(q.quantum) + 1.0;
    code_of_largest(q, q.top);
    Ints8 whole;
    narrow(at_most(Doubles8(q.top), last), whole);
    q.top = __builtin_convertvector(whole, Floats8);
    for (;;) {
      const Ints8 above = active & (q.top > 0.0F) & ~(q.top * q.quantum + q.minimum <= r_.max);
      if (!any_lane(above)) return;
      q.top = above ? q.top - 1.0F : q.top;
    }
  }

  // Sets the largest quantum for which level `code` does not lie above the range, in the lanes that `asked` selects.
  [[gnu::always_inline]] void quantum_up_to(const Floats8& code, const Floats8& minimum, const Ints8& asked,
                                            Floats8& quantum) const {
    narrow(at_most(most_value_ - Doubles8(minimum), kWidest) / Doubles8(code), quantum);
    for (;;) {
      const Ints8 above = asked & (quantum > 0.0F) & (code * quantum + minimum > r_.max);
      if (!any_lane(above)) return;
      Ints8 bits;
      std::memcpy(&bits, &quantum, sizeof bits);
      bits += above;  // -1: the next float towards zero
      std::memcpy(&quantum, &bits, sizeof bits);
    }
  }

  [[gnu::always_inline]] void begins_outside(const Floats8& minimum, Ints8& outside) const {
    const Floats8 zero{};
    outside = ~(r_.min == zero ? minimum == zero : minimum >= r_.min);
  }

  [[gnu::always_inline]] void usable(const LaneQuantisers& q, Ints8& able) const {
    const Floats8 zero{};
    able = (q.quantum >= kLeastQuantum) & (q.quantum - q.quantum == zero) & (q.minimum - q.minimum == zero);
  }

  [[gnu::always_inline]] void scaled(const Floats8& value, Doubles8& deviation) const {
    deviation = (Doubles8(value) - mean_) * wide_scale_;
  }

  [[gnu::always_inline]] void from_mean(const Doubles8& minimum, const Doubles8& quantum, LaneQuantisers& q) const {
    narrow(mean_ + minimum * unscale_, q.minimum);
    narrow(quantum * unscale_, q.quantum);
  }

  [[gnu::always_inline]] void sum_terms(Doubles8& total) const {
    Floats8 sum;
    sum_groups(terms_.data(), shape_, sum);
    total = Doubles8(sum);
  }

  const Floats8* values_;
  const LaneShape& shape_;
  std::size_t count_;
  double times_;  // number of voxels of each value
  const LaneRanges& r_;
  Doubles8 least_;
  Doubles8 most_value_;
  Doubles8 mean_;
  Floats8 scale_;
  Doubles8 wide_scale_;
  Doubles8 unscale_;
  Doubles8 deviation_;  // sum of the deviations, which is not 0 because the mean is rounded
  Doubles8 squares_;    // sum of the squared deviations
  Doubles8 best_;
  Floats8 most_;
  std::array<Floats8, kMostLaneValues> deviations_;
  std::array<Floats8, kMostLaneValues> terms_;
};

}  // namespace weir
