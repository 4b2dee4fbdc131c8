#include "compressor/survey/range_histogram.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "format/base/simd.h"

namespace weir {
namespace {

// The smallest positive float is 2^-149, so finer bins would tell nothing more.
constexpr int kFinest = -149;

// Finds the bin of each value. floor() comes before the subtraction, because both operands are then integers that a
// double holds exactly. value * scale - base could round across an edge.
void bins_one_by_one(std::span<const float> values, double scale, double base, std::int32_t* bins) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    bins[i] = static_cast<std::int32_t>(std::floor(static_cast<double>(values[i]) * scale) - base);
  }
}

// Does the same for `count` values, a multiple of eight, if floor(value * scale) fits 32 bits. `width` is 1 / scale.
// Products with powers of two are exact, except below the smallest normal number, and there they are cut to 0 anyway.
WEIR_SIMD void bins_by_eight(const float* values, std::size_t count, float scale, float width, std::int32_t base,
                             std::int32_t* bins) {
  for (std::size_t i = 0; i < count; i += 8) {
    Floats8 v;
    std::memcpy(&v, values + i, sizeof v);
    const Ints8 cut = __builtin_convertvector(v * scale, Ints8);            // towards zero
    const Ints8 above = __builtin_convertvector(cut, Floats8) * width > v;  // -1 if `cut` is not the floor
    const Ints8 bin = cut + above - base;
    std::memcpy(bins + i, &bin, sizeof bin);
  }
}

}  // namespace

RangeHistogram::RangeHistogram() : exponent_(kFinest), even_(kMaxBins), odd_(kMaxBins) {}

RangeHistogram::Bins RangeHistogram::at(int exponent) const {
  if (bins_ == 0) return {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  const double shrink = std::ldexp(1.0, exponent_ - exponent);
  return {std::floor(base_ * shrink), std::floor((base_ + static_cast<double>(bins_ - 1)) * shrink)};
}

void RangeHistogram::grow(int exponent, const std::function<Bins(int)>& other) {
  for (;; ++exponent) {
    const Bins mine = at(exponent);
    const Bins theirs = other(exponent);
    const Bins all{std::min(mine.first, theirs.first), std::max(mine.last, theirs.last)};
    if (all.last - all.first >= static_cast<double>(kMaxBins)) continue;
    const double shrink = std::ldexp(1.0, exponent_ - exponent);
    for (auto* table : {&even_, &odd_}) {
      std::vector<std::uint64_t> merged(kMaxBins);
      for (std::size_t i = 0; i < bins_; ++i) {
        // Bins that no float falls into may have an edge that double cannot hold; they are empty.
        if ((*table)[i] == 0) continue;
        merged[static_cast<std::size_t>(std::floor((base_ + static_cast<double>(i)) * shrink) - all.first)] +=
            (*table)[i];
      }
      table->swap(merged);
    }
    exponent_ = exponent;
    scale_ = std::ldexp(1.0, -exponent);
    base_ = all.first + 0.0;  // makes -0.0 a 0.0: either may come first
    bins_ = static_cast<std::size_t>(all.last - all.first) + 1;
    return;
  }
}

void RangeHistogram::cover(float low, float high) {
  const auto range_at = [&](int exponent) {
    const double scale = std::ldexp(1.0, -exponent);
    return Bins{std::floor(static_cast<double>(low) * scale), std::floor(static_cast<double>(high) * scale)};
  };
  const Bins range = range_at(exponent_);
  if (range.first >= base_ && range.last < base_ + static_cast<double>(bins_)) return;
  grow(exponent_, range_at);
}

void RangeHistogram::add(std::span<const float> values, float low, float high, std::uint64_t times) {
  cover(low, high);
  constexpr std::size_t kPiece = 512;
  std::array<std::int32_t, kPiece> bins;
  // True if a float holds scale and width, and 32 bits hold the bins.
  const bool small = std::abs(base_) < 0x1p30 && exponent_ > -std::numeric_limits<float>::max_exponent;
  const auto scale = small ? static_cast<float>(scale_) : 0.0F;
  const float width = small ? std::ldexp(1.0F, exponent_) : 0.0F;
  while (!values.empty()) {
    const std::size_t count = std::min(values.size(), kPiece);
    const std::size_t eights = small ? count / 8 * 8 : 0;
    if (eights > 0) bins_by_eight(values.data(), eights, scale, width, static_cast<std::int32_t>(base_), bins.data());
    bins_one_by_one(values.subspan(eights, count - eights), scale_, base_, bins.data() + eights);
    std::size_t i = 0;
    for (; i + 1 < count; i += 2) {
      even_[static_cast<std::size_t>(bins[i])] += times;
      odd_[static_cast<std::size_t>(bins[i + 1])] += times;
    }
    if (i < count) even_[static_cast<std::size_t>(bins[i])] += times;
    values = values.subspan(count);
  }
}

void RangeHistogram::add(float value, std::uint64_t count) {
  if (count == 0) return;
  cover(value, value);
  even_[bin_of(value)] += count;
}

void RangeHistogram::merge(const RangeHistogram& other) {
  if (other.empty()) return;
  RangeHistogram theirs = other;
  grow(std::max(exponent_, theirs.exponent_), [&](int exponent) { return theirs.at(exponent); });
  theirs.grow(exponent_, [&](int exponent) { return at(exponent); });
  for (std::size_t i = 0; i < kMaxBins; ++i) {
    even_[i] += theirs.even_[i];
    odd_[i] += theirs.odd_[i];
  }
}

RangeHistogram RangeHistogram::restored(int exponent, double base, std::span<const std::uint64_t> counts) {
  RangeHistogram histogram;
  histogram.exponent_ = exponent;
  histogram.scale_ = std::ldexp(1.0, -exponent);
  histogram.base_ = base;
  histogram.bins_ = counts.size();
  std::copy(counts.begin(), counts.end(), histogram.even_.begin());
  return histogram;
}

double RangeHistogram::bin_width() const { return std::ldexp(1.0, exponent_); }

double RangeHistogram::first_edge() const { return std::ldexp(base_, exponent_); }

std::vector<std::uint64_t> RangeHistogram::counts() const {
  std::vector<std::uint64_t> total(bins_);
  for (std::size_t i = 0; i < bins_; ++i) total[i] = even_[i] + odd_[i];
  return total;
}

std::size_t RangeHistogram::bin_of(float value) const {
  return static_cast<std::size_t>(std::floor(static_cast<double>(value) * scale_) - base_);
}

}  // namespace weir
