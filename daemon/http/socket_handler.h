// Who takes a connection over whose client asks for a WebSocket: from then on it is no HttpSession's any more.
#pragma once

#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <functional>
#include <optional>

#include "daemon/http/http_message.h"

namespace weir {

using UpgradeRequest = boost::beast::http::request<boost::beast::http::string_body>;

/// Both are called on the io_context's thread and must not block; without `take` such a request is like any other.
struct SocketHandler {
  /// The refusal of a request for a WebSocket, or none.
  std::function<std::optional<HttpResponse>(const HttpRequest&)> refuse;
  /// Has the connection of a request that was not refused, and answers it.
  std::function<void(boost::asio::generic::stream_protocol::socket, UpgradeRequest)> take;
};

}  // namespace weir
