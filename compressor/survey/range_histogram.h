// A one-pass histogram. Its result depends on the values alone, not on their order or on how the work was divided. A
// bin is a power of two wide and its edges are multiples of the width. Neighbouring bins merge when the range grows. At
// the end 513 to 1024 bins cover the range (one bin if all values are equal, fewer if the range is below 512 times the
// smallest denormal).
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

  /// Adds finite values, each `times` times. `low` and `high` are the smallest and the largest of them.
  void add(std::span<const float> values, float low, float high, std::uint64_t times = 1);
  /// Adds one finite value `count` times.
  void add(float value, std::uint64_t count);
  void merge(const RangeHistogram& other);

  bool empty() const { return bins_ == 0; }
  double bin_width() const;
  /// Returns the lower edge of the first bin. Bin i covers [first_edge + i w, first_edge + (i + 1) w), with
  /// w = bin_width().
  double first_edge() const;
  /// Returns the counts of the covered bins.
  std::vector<std::uint64_t> counts() const;

  /// exponent(), base() and counts() are the whole state: restored(h.exponent(), h.base(), h.counts()) behaves exactly
  /// as h.
  int exponent() const { return exponent_; }  ///< bins are 2^exponent wide
  double base() const { return base_; }       ///< first_edge() in bin widths, an integer
  static RangeHistogram restored(int exponent, double base, std::span<const std::uint64_t> counts);

  /// Returns the bin of a value, which must lie inside the range.
  std::size_t bin_of(float value) const;

 private:
  // The first and the last bin of a range, as multiples of the bin width.
  struct Bins {
    double first;
    double last;
  };
  Bins at(int exponent) const;
  // Widens the bins, beginning with 2^exponent, until kMaxBins of them cover this range and the range of `other`.
  void grow(int exponent, const std::function<Bins(int)>& other);
  void cover(float low, float high);

  int exponent_;          // bins are 2^exponent wide
  double scale_ = 0;      // 2^-exponent
  double base_ = 0;       // floor(lowest value / width): an integer, exact in double
  std::size_t bins_ = 0;  // number of bins that cover the range
  // Two tables, so that equal neighbours do not wait for each other's increment.
  std::vector<std::uint64_t> even_;
  std::vector<std::uint64_t> odd_;
};

}  // namespace weir
