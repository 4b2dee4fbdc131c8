// The largest of any stretch of a fixed sequence in constant time: a sparse table
// of the maxima of all stretches of 2^k entries.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <utility>
#include <vector>

namespace weir {

class RangeMax {
 public:
  /// At least one value.
  explicit RangeMax(std::vector<float> values) {
    std::vector<float> level = std::move(values);
    for (std::size_t half = 1;; half *= 2) {
      levels_.push_back(level);
      if (2 * half > level.size()) break;
      for (std::size_t i = 0; i + half < level.size(); ++i) level[i] = std::max(level[i], level[i + half]);
    }
  }

  /// Of the entries first to last, both included.
  float between(std::size_t first, std::size_t last) const {
    const auto k = static_cast<std::size_t>(std::bit_width(last - first + 1) - 1);
    return std::max(levels_[k][first], levels_[k][last + 1 - (std::size_t{1} << k)]);
  }
  std::size_t size() const { return levels_.front().size(); }

 private:
  std::vector<std::vector<float>> levels_;  ///< [k][i]: largest of entries i .. i + 2^k - 1
};

}  // namespace weir
