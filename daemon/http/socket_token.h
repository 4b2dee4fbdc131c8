// The token of a WebSocket: a page cannot send a header with it, so the token comes as one of the protocols that it
// offers, "weir.token." and the token's bytes in hex.
#pragma once

#include <string>
#include <string_view>

#include "daemon/http/http_message.h"

namespace weir {

/// The same request with the token among its protocols as that of a header Authorization, where there is one.
HttpRequest with_offered_token(HttpRequest request);
/// A header Sec-WebSocket-Protocol without those that are tokens.
std::string without_offered_token(std::string_view protocols);

}  // namespace weir
