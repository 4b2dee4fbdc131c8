// Listens on one address and keeps the connections; each is an HttpSession.
// Knows the limits, not what is asked or answered. One thread: that of the
// io_context, which must outlive the server.
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
  /// Listens from here on, as ListeningSocket says. Connections that `sockets` wants go there.
  HttpServer(boost::asio::io_context& io, const ListenAddress& address, const HttpLimits& limits, HttpHandler handler,
             SocketHandler sockets = {});
  /// Closes everything; no call of `handler` comes afterwards.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// The port it listens on; 0 for a Unix socket.
  std::uint16_t port() const;

 private:
  class Listener;
  std::shared_ptr<Listener> listener_;
};

}  // namespace weir
