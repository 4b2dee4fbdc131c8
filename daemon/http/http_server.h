// Listens on one address and owns the connections; each is an HttpSession. Enforces the limits, and knows nothing of
// requests and answers. One thread: the io_context's. The io_context must outlive the server.
#pragma once

#include <boost/asio/io_context.hpp>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "daemon/config/listen_address.h"
#include "daemon/http/http_limits.h"
#include "daemon/http/http_message.h"
#include "daemon/http/socket_handler.h"

namespace weir {

class HttpServer {
 public:
  /// Listens from here on, with the errors of ListeningSocket. Connections that `sockets` wants are handed to it.
  HttpServer(boost::asio::io_context& io, const ListenAddress& address, const HttpLimits& limits, HttpHandler handler,
             SocketHandler sockets = {});
  /// Closes all connections; `handler` is not called afterwards.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// Returns the port that it listens on; 0 for a Unix socket.
  std::uint16_t port() const;

 private:
  class Listener;
  std::shared_ptr<Listener> listener_;
};

}  // namespace weir
