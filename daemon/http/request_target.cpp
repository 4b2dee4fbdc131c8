#include "daemon/http/request_target.h"

#include <charconv>

#include "format/base/text.h"

namespace weir {
namespace {

constexpr std::string_view kHex = "0123456789ABCDEF";

bool is_unreserved(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("-._~").find(c) != std::string_view::npos;
}

std::optional<std::string> percent_decode(std::string_view text, bool plus_is_space) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      decoded += plus_is_space && text[i] == '+' ? ' ' : text[i];
      continue;
    }
    const std::string_view digits = text.substr(i + 1, 2);
    unsigned value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
    if (digits.size() != 2 || error != std::errc() || end != digits.data() + 2) return std::nullopt;
    decoded += static_cast<char>(value);
    i += 2;
  }
  return decoded;
}

bool add_parameter(std::map<std::string, std::string>& query, std::string_view parameter) {
  const std::size_t equals = parameter.find('=');
  const auto name = percent_decode(parameter.substr(0, equals), true);
  const auto value =
      equals == std::string_view::npos ? std::string() : percent_decode(parameter.substr(equals + 1), true);
  if (!name || !value) return false;
  return parameter.empty() || query.emplace(*name, *value).second;
}

}  // namespace

std::optional<RequestTarget> parse_target(std::string_view target) {
  if (!target.starts_with('/')) return std::nullopt;
  RequestTarget result;
  const std::size_t question = target.find('?');
  const std::string_view path = target.substr(1, question == std::string_view::npos ? question : question - 1);
  if (!path.empty()) {
    for (const std::string& segment : split(path, '/')) {
      const auto decoded = percent_decode(segment, false);
      if (!decoded) return std::nullopt;
      result.path.push_back(*decoded);
    }
  }
  if (question != std::string_view::npos) {
    for (const std::string& parameter : split(target.substr(question + 1), '&')) {
      if (!add_parameter(result.query, parameter)) return std::nullopt;
    }
  }
  return result;
}

std::string percent_encode(std::string_view text) {
  std::string encoded;
  for (const char c : text) {
    if (is_unreserved(c)) {
      encoded += c;
    } else {
      const auto byte = static_cast<unsigned char>(c);
      encoded += {'%', kHex[byte >> 4], kHex[byte & 15]};
    }
  }
  return encoded;
}

}  // namespace weir
