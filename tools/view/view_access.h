// The access rules between a page and the server of weir view.
#pragma once

#include <string>
#include <string_view>

namespace weir {

/// The WebSocket protocol that the server speaks and a page must offer.
inline constexpr std::string_view kViewProtocol = "weir.view";

/// Returns whether `protocols`, a header Sec-WebSocket-Protocol, offers `wanted`.
bool offers_protocol(std::string_view protocols, std::string_view wanted);
/// Returns the connect sources for the page's content security policy: the WebSocket at `host`, the Host header,
/// because not every browser counts it as the page's own. Empty if `host` is no plain name.
std::string socket_sources(std::string_view host);

}  // namespace weir
