// Who takes a connection over, that of a client which asks for a WebSocket, say: from then on it is no HttpSession's
// any more.
#pragma once

#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <functional>
#include <optional>

#include "daemon/http/http_message.h"

namespace weir {

using UpgradeRequest = boost::beast::http::request<boost::beast::http::string_body>;

/// All are called on the io_context's thread and must not block; without `take` no connection is handed over.
struct SocketHandler {
  /// The refusal of a request whose connection would be handed over, or none.
  std::function<std::optional<HttpResponse>(const HttpRequest&)> refuse;
  /// Has the connection of a request that was not refused, and answers it.
  std::function<void(boost::asio::generic::stream_protocol::socket, UpgradeRequest)> take;
  /// Whether the connection of a request is handed over; where this is empty, that of one for a WebSocket.
  std::function<bool(const HttpRequest&)> wants{};
};

}  // namespace weir
