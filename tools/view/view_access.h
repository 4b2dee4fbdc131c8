// What a page and the server of weir view agree on before they talk.
#pragma once

#include <string>
#include <string_view>

namespace weir {

/// The protocol that the server speaks, and a page has to offer.
inline constexpr std::string_view kViewProtocol = "weir.view";

/// Whether the header Sec-WebSocket-Protocol offers it.
bool offers_protocol(std::string_view protocols, std::string_view wanted);
/// Where the page of a server that is asked for by that Host may connect to, in the words of a content policy: its
/// WebSocket, which not every browser counts as its own. Empty for a Host that is no plain name.
std::string socket_sources(std::string_view host);

}  // namespace weir
