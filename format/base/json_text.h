// JSON as one line of text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace weir {

/// `value`, of type nlohmann::json or ordered_json, on one line. Bytes that are not UTF-8, as paths may have them,
/// become U+FFFD.
template <typename Json>
std::string json_text(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace weir
