#include "daemon/config/glob.h"

#include <optional>
#include <utility>

namespace weir {
namespace {

/// Returns the first component and the rest of the path. The rest is nullopt if there is no slash; behind a slash, it
/// may be an empty component.
std::pair<std::string_view, std::optional<std::string_view>> cut(std::string_view path) {
  const std::size_t slash = path.find('/');
  if (slash == std::string_view::npos) return {path, std::nullopt};
  return {path.substr(0, slash), path.substr(slash + 1)};
}

/// Returns the length of the set at the beginning of `pattern`, with its brackets; 0 if the set has no end.
std::size_t set_length(std::string_view pattern) {
  std::size_t at = 1;
  if (at < pattern.size() && (pattern[at] == '!' || pattern[at] == '^')) ++at;
  if (at < pattern.size() && pattern[at] == ']') ++at;  // a bracket at the first place is a member of the set
  while (at < pattern.size() && pattern[at] != ']') ++at;
  return at < pattern.size() ? at + 1 : 0;
}

bool in_set(std::string_view set, char c) {
  set = set.substr(1, set.size() - 2);
  const bool negated = !set.empty() && (set.front() == '!' || set.front() == '^');
  if (negated) set.remove_prefix(1);
  const auto byte = [](char b) { return static_cast<unsigned char>(b); };
  for (std::size_t i = 0; i < set.size(); ++i) {
    const bool range = i + 2 < set.size() && set[i + 1] == '-';
    if (range ? byte(set[i]) <= byte(c) && byte(c) <= byte(set[i + 2]) : set[i] == c) return !negated;
    if (range) i += 2;
  }
  return negated;
}

/// Returns the length of the part of `pattern` that matches the one byte `c`; 0 if it does not match.
std::size_t match_byte(std::string_view pattern, char c) {
  if (pattern.empty()) return 0;
  if (pattern.front() == '?') return 1;
  if (pattern.front() == '\\' && pattern.size() > 1) return pattern[1] == c ? 2 : 0;
  if (pattern.front() == '[') {
    if (const std::size_t length = set_length(pattern)) return in_set(pattern.substr(0, length), c) ? length : 0;
  }
  return pattern.front() == c ? 1 : 0;
}

/// Matches one component. Backtracks only to the last star, one byte at a time: linear for each star.
bool match_name(std::string_view pattern, std::string_view name) {
  if (name.starts_with('.') && !pattern.starts_with('.') && !pattern.starts_with("\\.")) return false;
  std::optional<std::string_view> after_star;
  std::string_view rest_of_star;
  while (!name.empty()) {
    if (pattern.starts_with('*')) {
      pattern.remove_prefix(1);
      after_star = pattern;
      rest_of_star = name;
    } else if (const std::size_t length = match_byte(pattern, name.front())) {
      pattern.remove_prefix(length);
      name.remove_prefix(1);
    } else if (after_star) {
      rest_of_star.remove_prefix(1);
      pattern = *after_star;
      name = rest_of_star;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*') == std::string_view::npos;
}

}  // namespace

bool matches_glob(std::string_view pattern, std::string_view path) {
  std::optional<std::string_view> patterns = pattern;
  std::optional<std::string_view> names = path;
  std::optional<std::string_view> after_stars;  // backtracks like match_name, one component at a time
  std::optional<std::string_view> rest_of_stars;
  bool any_stars = false;
  while (names) {
    const auto [name, later_names] = cut(*names);
    if (patterns) {
      const auto [first, later_patterns] = cut(*patterns);
      if (first == "**") {
        any_stars = true;
        after_stars = patterns = later_patterns;
        rest_of_stars = names;
        continue;
      }
      if (match_name(first, name)) {
        patterns = later_patterns;
        names = later_names;
        continue;
      }
    }
    // `**` takes one more component, but never a hidden one.
    if (!any_stars || rest_of_stars->starts_with('.')) return false;
    rest_of_stars = cut(*rest_of_stars).second;
    patterns = after_stars;
    names = rest_of_stars;
  }
  while (patterns && cut(*patterns).first == "**") patterns = cut(*patterns).second;
  return !patterns;
}

bool matches_pattern(std::string_view pattern, std::string_view path) {
  const bool of_name = pattern.find('/') == std::string_view::npos;
  return matches_glob(pattern, of_name ? path.substr(path.find_last_of('/') + 1) : path);
}

}  // namespace weir
