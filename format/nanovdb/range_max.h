// Returns the largest value of any stretch of a fixed sequence in constant time, from a sparse table of the maxima of
// all stretches of 2^k entries.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "format/base/host_device.h"

namespace weir {

/// The part of a RangeMax that a kernel needs.
struct RangeMaxView {
  const float* levels = nullptr;  ///< [k * size + i]: largest of entries i .. i + 2^k - 1
  std::uint32_t size = 0;

  /// Returns the largest of the entries first to last, both included.
  WEIR_HOST_DEVICE float between(std::uint32_t first, std::uint32_t last) const {
    std::uint32_t width = 1;
    const float* level = levels;
    for (; 2 * width <= last - first + 1; width *= 2) level += size;
    const float a = level[first];
    const float b = level[last + 1 - width];
    return a < b ? b : a;
  }
};

class RangeMax {
 public:
  /// `values` has at least one value and fewer than 2^31.
  explicit RangeMax(std::vector<float> values) : size_(values.size()), levels_(std::move(values)) {
    for (std::size_t half = 1, below = 0; 2 * half <= size_; half *= 2, below += size_) {
      levels_.resize(below + 2 * size_);
      for (std::size_t i = below; i < below + size_; ++i) {
        levels_[i + size_] = std::max(levels_[i], levels_[std::min(i + half, below + size_ - 1)]);
      }
    }
  }

  RangeMaxView view() const { return {levels_.data(), static_cast<std::uint32_t>(size_)}; }
  const std::vector<float>& levels() const { return levels_; }
  float between(std::size_t first, std::size_t last) const {
    return view().between(static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last));
  }
  std::size_t size() const { return size_; }

 private:
  std::size_t size_;
  std::vector<float> levels_;
};

}  // namespace weir
