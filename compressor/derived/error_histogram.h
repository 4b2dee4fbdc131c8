// The distribution of |error|: counts in bins with a small relative width, so that quantiles of any volume take one
// pass and little memory.
#pragma once

#include <cstdint>
#include <vector>

namespace weir {

/// Has 256 bins per octave from 2^-150 to 2^130, the range of differences of two float32, and one bin for 0.
class ErrorHistogram {
 public:
  ErrorHistogram() : counts_(kBins) {}

  /// Adds an absolute error, which must be finite and not negative.
  void add(double size);
  void add(const ErrorHistogram& other);

  std::uint64_t count() const { return count_; }
  /// Returns a size that the share `share` of all added sizes does not exceed. 0 < share <= 1; the number of sizes is
  /// rounded up. The result is the end of a bin, at most 0.4 % above the smallest possible size, and never above
  /// `largest`. Returns 0 if nothing was added.
  double quantile(double share, double largest) const;

  /// The number of sizes that are 0, and in counts[i] the number that lies in [2^(first + i), 2^(first + i + 1)). The
  /// first and the last count are above 0.
  struct Octaves {
    std::uint64_t zeros = 0;
    int first = 0;
    std::vector<std::uint64_t> counts;
  };
  Octaves octaves() const;

 private:
  static constexpr int kLowest = -150;
  static constexpr int kHighest = 130;
  static constexpr int kInOctave = 256;
  static constexpr std::size_t kBins = 1 + static_cast<std::size_t>(kHighest - kLowest) * kInOctave;

  static std::size_t bin_of(double size);
  static double end_of(std::size_t bin);

  std::vector<std::uint64_t> counts_;
  std::uint64_t count_ = 0;
};

}  // namespace weir
