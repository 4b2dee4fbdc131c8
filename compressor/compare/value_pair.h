// The values of a box of a volume and the decoded values of a file there, for the derived errors.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

#include "format/base/index.h"

namespace weir {

/// Source and decoded values, both x fastest over `box` (index space), which lies in `domain`.
struct ValuePair {
  Box domain;  ///< index box of the volume
  Box box;
  std::span<const float> source;
  std::span<const float> decoded;

  std::size_t at(const Index3& i) const { return static_cast<std::size_t>(linear_index(i - box.lo, box.extent())); }
  bool finite(std::size_t i) const { return std::isfinite(source[i]) && std::isfinite(decoded[i]); }
  double error(std::size_t i) const { return static_cast<double>(decoded[i]) - static_cast<double>(source[i]); }
};

}  // namespace weir
