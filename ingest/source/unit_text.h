// The text that a file gives as the unit of its values.
#pragma once

#include <cstddef>
#include <string>
#include <utility>

namespace weir {

inline constexpr std::size_t kMostUnitBytes = 128;

/// `text`, or nothing where it is longer than a unit is: it would stand in every line about a value.
inline std::string unit_text(std::string text) {
  return text.size() <= kMostUnitBytes ? std::move(text) : std::string();
}

}  // namespace weir
