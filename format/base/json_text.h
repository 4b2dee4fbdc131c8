// JSON as text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace weir {

/// `value`, of type nlohmann::json or ordered_json, on one line, or on several where each level is to be indented by so
/// many. Bytes that are not UTF-8, as paths may have them, become U+FFFD.
template <typename Json>
std::string json_text(const Json& value, int indent = -1) {
  return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace weir
