// Who may ask the control server: the rules that hold for every request, before
// anything is looked up for it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "daemon/http/http_message.h"

namespace weir {

struct AccessRules {
  std::string token;         ///< bearer token; empty: none is needed
  bool loopback = true;      ///< only this machine can connect, so a Host header that names another one is a trick
  std::string control_at{};  ///< the address at which alone a POST is answered; empty: here
  /// What a request with another token is told.
  std::string wrong_token =
      "the token is not the service's; take the one that its configuration names (token, token_file)";
};

/// Whether both are the same; takes as long for any `given` of one length, so that a token cannot be guessed byte by
/// byte from the time an answer takes.
bool same_secret(std::string_view secret, std::string_view given);

/// The refusal of `request`, or none. Refused are
///   - a Host header that is not a loopback name, on a loopback address: a foreign web page whose name was pointed at
///     127.0.0.1 would otherwise be read by the browser as the server's own (DNS rebinding), 421;
///   - where `open` is false, a request without the token, or with another one, 401 and a message for each;
///   - a POST where it is answered at another address, 403;
///   - a POST that a web page may send to a foreign server unasked: one with neither a JSON content type nor an X-Weir
///     header (cross-site request forgery), 403.
/// `open` is true for what shows no data: the health checks and the page's own files.
std::optional<HttpResponse> refuse(const AccessRules& rules, const HttpRequest& request, bool open);

/// The refusal of a WebSocket, which no token in a header and no rule of the browser guards, or none: where its Origin
/// is there and is not the place that Host names, a foreign page asks (cross-site WebSocket hijacking), 403; else as
/// refuse() of a request for data.
std::optional<HttpResponse> refuse_socket(const AccessRules& rules, const HttpRequest& request);

}  // namespace weir
