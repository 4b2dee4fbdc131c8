// The token of a WebSocket. A page cannot send an Authorization header with it, so the page offers the token as a
// protocol: "weir.token." and the token's bytes in hex.
#pragma once

#include <string>
#include <string_view>

#include "daemon/http/http_message.h"

namespace weir {

/// Returns the request with the token among its protocols, if there is one, as its Authorization header.
HttpRequest with_offered_token(HttpRequest request);
/// Returns the value of a Sec-WebSocket-Protocol header without the protocols that are tokens.
std::string without_offered_token(std::string_view protocols);

}  // namespace weir
