// How |error| is distributed: counts in bins that are narrow in proportion, so that quantiles of any volume take one
// pass and little memory.
#pragma once

#include <cstdint>
#include <vector>

namespace weir {

/// 256 bins to an octave from 2^-150 to 2^130, which differences of two float32 lie between, and one for 0.
class ErrorHistogram {
 public:
  ErrorHistogram() : counts_(kBins) {}

  /// `size` is finite and not negative.
  void add(double size);
  void add(const ErrorHistogram& other);

  std::uint64_t count() const { return count_; }
  /// A size that the share `share` of all, 0 < share <= 1, rounded up to whole ones, do not exceed: the end of its bin,
  /// at most 0.4 % above the smallest such size, and never above `largest`. 0 where nothing was added.
  double quantile(double share, double largest) const;

  /// How many sizes are 0, and how many lie in [2^(first + i), 2^(first + i + 1)), the first and the last of which are
  /// not none.
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
