// Letters, digits and white space of ASCII, independent of the locale. Other bytes belong to none of them.
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <string_view>

namespace weir {

/// Returns whether `c` is a blank, a tab (horizontal or vertical), a line end or a form feed; false for a negative `c`
/// (the end of a file).
constexpr bool is_space(int c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }
constexpr bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// Returns `text` without white space at both ends.
constexpr std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

/// Returns `text` with its ASCII letters in lower case.
inline std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower;
}

/// Returns whether `text` ends with one of `endings`, ignoring case. `endings` are in lower case.
inline bool ends_with_one_of(std::string_view text, std::span<const std::string_view> endings) {
  const std::string lower = lower_case(text);
  return std::ranges::any_of(endings, [&](std::string_view ending) { return lower.ends_with(ending); });
}

/// Returns `text` with its ASCII letters in upper case.
inline std::string upper_case(std::string_view text) {
  std::string upper(text);
  for (char& c : upper) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return upper;
}

}  // namespace weir
