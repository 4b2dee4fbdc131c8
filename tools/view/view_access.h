// The token of a viewer: a page cannot send a header with its WebSocket, so the token comes as one of the protocols
// that it offers, "weir.token." and the token's bytes in hex.
#pragma once

#include <string>
#include <string_view>

#include "daemon/http/http_message.h"

namespace weir {

/// The protocol that the server speaks, and a page has to offer.
inline constexpr std::string_view kViewProtocol = "weir.view";

/// Whether the header Sec-WebSocket-Protocol offers it.
bool offers_protocol(std::string_view protocols, std::string_view wanted);
/// The same request with the token among its protocols as that of a header Authorization, where there is one.
HttpRequest with_offered_token(HttpRequest request);
/// Where the page of a server that is asked for by that Host may connect to, in the words of a content policy: its
/// WebSocket, which not every browser counts as its own. Empty for a Host that is no plain name.
std::string socket_sources(std::string_view host);

}  // namespace weir
