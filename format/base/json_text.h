// JSON as text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace weir {

/// Returns `value`, of type nlohmann::json or ordered_json, on one line, or on several lines if `indent` (blanks per
/// level) is at least 0. Bytes that are not UTF-8, which a path may hold, become U+FFFD.
template <typename Json>
std::string json_text(const Json& value, int indent = -1) {
  return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace weir
