// The text that a file gives as the unit of its values.
#pragma once

#include <cstddef>
#include <string>
#include <utility>

namespace weir {

inline constexpr std::size_t kMostUnitBytes = 128;

/// Returns `text`, or "" if it is longer than kMostUnitBytes, because the unit appears in every message about a
/// value.
inline std::string unit_text(std::string text) {
  return text.size() <= kMostUnitBytes ? std::move(text) : std::string();
}

}  // namespace weir
