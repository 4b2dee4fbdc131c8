// The parsed target of a request, for example "/api/jobs?state=failed&limit=20".
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weir {

struct RequestTarget {
  std::vector<std::string> path;             ///< segments, percent-decoded; none for "/"
  std::map<std::string, std::string> query;  ///< percent-decoded; "+" means a space
};

/// Returns none if `target` does not begin with a slash, has a percent sign without two hex digits, or names a
/// parameter twice.
std::optional<RequestTarget> parse_target(std::string_view target);

/// Returns `text` with every byte except letters, digits and "-._~" as %XX, for use in a segment or a query value.
std::string percent_encode(std::string_view text);

}  // namespace weir
