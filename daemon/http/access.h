// Who may use the control server: the rules for every request. They are checked before anything is looked up for it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "daemon/http/http_message.h"

namespace weir {

struct AccessRules {
  std::string token;     ///< bearer token; empty: no token is needed
  bool loopback = true;  ///< only this machine can connect, so a Host header that names another machine is an attack
  std::string control_at{};  ///< the only address that answers POST; empty: this server answers POST
  /// The message for a request with a wrong token.
  std::string wrong_token =
      "the token is not the service's; take the one that its configuration names (token, token_file)";
};

/// Returns whether both are the same. The time depends only on the length of `given`, so that a token cannot be
/// guessed byte by byte from the time of an answer.
bool same_secret(std::string_view secret, std::string_view given);

/// Returns the refusal of `request`, or none. Refused are
///   - a Host header that is not a loopback name, on a loopback address, 421. Otherwise a foreign web page whose name
///     points at 127.0.0.1 could read the server's answers like its own (DNS rebinding);
///   - if `open` is false, a request without the token, or with a wrong one, 401 with a message for each case;
///   - a POST if another address answers POST, 403;
///   - a POST that a web page may send to a foreign server without asking: one with neither a JSON content type nor
///     an X-Weir header (cross-site request forgery), 403.
/// `open` is true for requests that show no data: the health checks and the page's own files.
std::optional<HttpResponse> refuse(const AccessRules& rules, const HttpRequest& request, bool open);

/// Returns the refusal of a WebSocket request, or none. A browser lets any page open a WebSocket and sends no
/// Authorization header with it. If the Origin header is there and differs from Host, a foreign page asks (cross-site
/// WebSocket hijacking), 403. All other rules are those of refuse() for a request for data.
std::optional<HttpResponse> refuse_socket(const AccessRules& rules, const HttpRequest& request);

}  // namespace weir
