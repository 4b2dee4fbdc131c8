// Durations as a cumulative histogram for Prometheus. Its bounds, in seconds, suit conversions (0.1 s to some hours).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace weir {

class SecondsHistogram {
 public:
  /// Upper bounds, inclusive. Longer durations count in `count()` alone.
  static constexpr std::array<double, 14> kBounds = {0.1, 0.25, 0.5, 1, 2.5, 5, 10, 30, 60, 120, 300, 900, 3600, 14400};

  void observe(double seconds) {
    const auto bound = std::lower_bound(kBounds.begin(), kBounds.end(), seconds);
    if (bound != kBounds.end()) ++bins_[static_cast<std::size_t>(bound - kBounds.begin())];
    ++count_;
    sum_ += seconds;
  }

  /// Returns how many durations were at most kBounds[bound] seconds.
  std::uint64_t at_most(std::size_t bound) const {
    std::uint64_t total = 0;
    for (std::size_t i = 0; i <= bound; ++i) total += bins_[i];
    return total;
  }
  std::uint64_t count() const { return count_; }
  double sum() const { return sum_; }

 private:
  std::array<std::uint64_t, kBounds.size()> bins_{};
  std::uint64_t count_ = 0;
  double sum_ = 0;
};

}  // namespace weir
