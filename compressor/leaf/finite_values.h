// Checks of a leaf's values: whether all are finite, and whether all are the same.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>

#include "format/leaf/leaf_codec.h"

namespace weir {

bool all_finite(const LeafValues& values);

/// Returns whether all values have the same bits. There must be at least one value.
inline bool holds_one_value(std::span<const float> values) {
  const auto first = std::bit_cast<std::uint32_t>(values.front());
  return std::all_of(values.begin(), values.end(), [&](float v) { return std::bit_cast<std::uint32_t>(v) == first; });
}

}  // namespace weir
