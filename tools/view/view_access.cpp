#include "tools/view/view_access.h"

#include <cstdint>
#include <optional>
#include <vector>

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

bool offers_protocol(std::string_view protocols, std::string_view wanted) {
  for (const std::string& offered : split(protocols, ',')) {
    if (trimmed(offered) == wanted) return true;
  }
  return false;
}

HttpRequest with_offered_token(HttpRequest request) {
  for (const std::string& offered : split(request.protocols, ',')) {
    const std::string_view name = trimmed(offered);
    if (!name.starts_with(kTokenProtocol)) continue;
    request.authorization = cat("Bearer ", from_hex(name.substr(kTokenProtocol.size())).value_or(""));
  }
  return request;
}

std::string socket_sources(std::string_view host) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-:[]";
  if (host.empty() || host.find_first_not_of(kPlain) != std::string_view::npos) return "";
  return cat("ws://", host, " wss://", host);
}

}  // namespace weir
