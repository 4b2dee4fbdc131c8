// A one-pass histogram whose result depends on the values alone: bins are a
// power of two wide with edges at its multiples, and neighbours merge as the
// range grows. In the end the range is covered by 513 to 1024 bins (one bin where
// all values are equal, fewer where the range is below 512 of the smallest
// denormal), whatever the order and however the work was divided.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace weir {

class RangeHistogram {
 public:
  static constexpr std::size_t kMaxBins = 1024;

  RangeHistogram();

  /// Adds finite values, all within [low, high] (both occur among the values), each `times`.
  void add(std::span<const float> values, float low, float high, std::uint64_t times = 1);
  /// Adds one finite value `count` times.
  void add(float value, std::uint64_t count);
  void merge(const RangeHistogram& other);

  bool empty() const { return bins_ == 0; }
  double bin_width() const;
  /// Lower edge of the first bin; bin i covers [first_edge + i w, first_edge + (i + 1) w).
  double first_edge() const;
  /// Counts of the covered bins.
  std::vector<std::uint64_t> counts() const;

  /// The whole state: restored(h.exponent(), h.base(), h.counts()) behaves exactly as h.
  int exponent() const { return exponent_; }  ///< bins are 2^exponent wide
  double base() const { return base_; }       ///< first_edge() in bin widths, an integer
  static RangeHistogram restored(int exponent, double base, std::span<const std::uint64_t> counts);

  /// Bin that a value inside the range falls into.
  std::size_t bin_of(float value) const;

 private:
  // First and last bin of a range, for bins 2^exponent wide.
  struct Bins {
    double first;
    double last;
  };
  Bins at(int exponent) const;
  // Widens the bins from 2^exponent on until they cover this range and `other`'s.
  void grow(int exponent, const std::function<Bins(int)>& other);
  void cover(float low, float high);

  int exponent_;          // bins are 2^exponent wide
  double scale_ = 0;      // 2^-exponent
  double base_ = 0;       // floor(lowest value / width): an integer, exact in double
  std::size_t bins_ = 0;  // covered ones
  // Two tables, so that equal neighbours do not wait for each other's increment.
  std::vector<std::uint64_t> even_;
  std::vector<std::uint64_t> odd_;
};

}  // namespace weir
