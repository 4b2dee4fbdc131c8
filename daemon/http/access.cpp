#include "daemon/http/access.h"

#include "daemon/config/listen_address.h"
#include "format/base/ascii.h"
#include "format/base/text.h"

namespace weir {
namespace {

// Accepts "localhost:8470", "127.0.0.1", "[::1]:8470". The port is not checked: it may be that of a tunnel.
bool names_loopback(std::string_view host) {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    return end != std::string_view::npos && is_loopback(host.substr(1, end - 1));
  }
  return is_loopback(lower_case(host.substr(0, host.find(':'))));
}

// Compares the media type without its parameters.
bool is_json(std::string_view content_type) {
  return lower_case(trimmed(content_type.substr(0, content_type.find(';')))) == "application/json";
}

// Returns the token of an Authorization header; none if the header uses another scheme.
std::optional<std::string_view> bearer_token(std::string_view authorization) {
  constexpr std::string_view kScheme = "bearer ";
  if (lower_case(authorization.substr(0, kScheme.size())) != kScheme) return std::nullopt;
  return authorization.substr(kScheme.size());
}

HttpResponse refuse_token(const AccessRules& rules, bool given) {
  HttpResponse response = given ? error_response(401, rules.wrong_token)
                                : error_response(401, "this needs the service's token: Authorization: Bearer TOKEN");
  response.headers.emplace_back("WWW-Authenticate", given ? "Bearer error=\"invalid_token\"" : "Bearer");
  return response;
}

}  // namespace

bool same_secret(std::string_view secret, std::string_view given) {
  // The number of steps depends only on the length of `given`, and no step depends on earlier comparisons.
  std::size_t difference = secret.size() ^ given.size();
  for (std::size_t i = 0; i < given.size(); ++i) {
    const char expected = secret.empty() ? '\0' : secret[i % secret.size()];
    difference |= static_cast<unsigned char>(expected ^ given[i]);
  }
  return difference == 0;
}

std::optional<HttpResponse> refuse(const AccessRules& rules, const HttpRequest& request, bool open) {
  if (rules.loopback && !request.host.empty() && !names_loopback(request.host)) {
    return error_response(421, cat("Host ", request.host, " is not this machine; ask for localhost or 127.0.0.1"));
  }
  if (!open && !rules.token.empty()) {
    const auto token = bearer_token(request.authorization);
    if (!token || !same_secret(rules.token, *token)) return refuse_token(rules, token.has_value());
  }
  if (request.method == "POST" && !rules.control_at.empty()) {
    return error_response(403, cat("this address only shows; ask at ", rules.control_at, " (--address, --config)"));
  }
  if (request.method == "POST" && !request.marked && !is_json(request.content_type)) {
    return error_response(403, "a POST needs Content-Type: application/json or an X-Weir header");
  }
  return std::nullopt;
}

std::optional<HttpResponse> refuse_socket(const AccessRules& rules, const HttpRequest& request) {
  const std::string origin = lower_case(request.origin);
  const std::string host = lower_case(request.host);
  if (!origin.empty() && origin != cat("http://", host) && origin != cat("https://", host)) {
    return error_response(403,
                          cat("Origin ", request.origin, " is not ", request.host, "; open this server's own page"));
  }
  return refuse(rules, request, false);
}

}  // namespace weir
