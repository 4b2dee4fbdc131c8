// Takes over a connection, for example that of a client that asks for a WebSocket. Afterwards the connection no
// longer belongs to an HttpSession.
#pragma once

#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <functional>
#include <optional>

#include "daemon/http/http_message.h"

namespace weir {

using UpgradeRequest = boost::beast::http::request<boost::beast::http::string_body>;

/// All functions are called on the io_context's thread and must not block. Without `take`, no connection is handed
/// over.
struct SocketHandler {
  /// Returns the refusal of a request whose connection would be handed over, or none.
  std::function<std::optional<HttpResponse>(const HttpRequest&)> refuse;
  /// Receives the connection of a request that was not refused, and answers the request.
  std::function<void(boost::asio::generic::stream_protocol::socket, UpgradeRequest)> take;
  /// Returns whether the connection of a request is handed over. If empty, WebSocket requests are handed over.
  std::function<bool(const HttpRequest&)> wants{};
};

}  // namespace weir
