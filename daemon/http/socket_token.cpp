#include "daemon/http/socket_token.h"

#include <optional>

#include "format/base/ascii.h"
#include "format/base/text.h"

namespace weir {
namespace {

constexpr std::string_view kTokenProtocol = "weir.token.";

std::optional<std::string> from_hex(std::string_view digits) {
  const auto value = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
  };
  if (digits.size() % 2 != 0) return std::nullopt;
  std::string text;
  for (std::size_t i = 0; i < digits.size(); i += 2) {
    if (value(digits[i]) < 0 || value(digits[i + 1]) < 0) return std::nullopt;
    text += static_cast<char>(16 * value(digits[i]) + value(digits[i + 1]));
  }
  return text;
}

}  // namespace

HttpRequest with_offered_token(HttpRequest request) {
  for (const std::string& offered : split(request.protocols, ',')) {
    const std::string_view name = trimmed(offered);
    if (!name.starts_with(kTokenProtocol)) continue;
    request.authorization = cat("Bearer ", from_hex(name.substr(kTokenProtocol.size())).value_or(""));
  }
  return request;
}

std::string without_offered_token(std::string_view protocols) {
  std::string kept;
  for (const std::string& offered : split(protocols, ',')) {
    const std::string_view name = trimmed(offered);
    if (!name.empty() && !name.starts_with(kTokenProtocol)) kept += cat(kept.empty() ? "" : ", ", name);
  }
  return kept;
}

}  // namespace weir
