// The target of a request, "/api/jobs?state=failed&limit=20", taken apart.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weir {

struct RequestTarget {
  std::vector<std::string> path;             ///< segments, percent-decoded; none for "/"
  std::map<std::string, std::string> query;  ///< percent-decoded, "+" is a space
};

/// None where `target` does not begin with a slash, holds a percent sign without two hex digits, or names a parameter
/// twice.
std::optional<RequestTarget> parse_target(std::string_view target);

/// `text` with every byte but letters, digits and "-._~" as %XX: fit for a segment or a query value.
std::string percent_encode(std::string_view text);

}  // namespace weir
