// What holds of all of some values.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>

#include "format/leaf/leaf_codec.h"

namespace weir {

bool all_finite(const LeafValues& values);

/// Whether all have the same bits; one at least.
inline bool holds_one_value(std::span<const float> values) {
  const auto first = std::bit_cast<std::uint32_t>(values.front());
  return std::all_of(values.begin(), values.end(), [&](float v) { return std::bit_cast<std::uint32_t>(v) == first; });
}

}  // namespace weir
