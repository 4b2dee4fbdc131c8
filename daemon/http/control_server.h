// The control server, on TCP and, if configured, on a Unix socket. Combines transport (http_server.h), access rules
// (access.h) and answers (api.h). Lives on the io_context's thread.
#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include "daemon/config/listen_address.h"
#include "daemon/http/control.h"
#include "daemon/http/http_limits.h"
#include "daemon/http/http_server.h"

namespace weir {

struct ControlServerSettings {
  ListenAddress address{"127.0.0.1", 8470};
  std::string token;  ///< bearer token that every request for data must have; empty: no token, allowed only on loopback
  std::string control_socket;  ///< path of a Unix socket that needs no token; if set, only this socket answers POST.
                               ///< Empty: no socket
  HttpLimits limits;
};

class ControlServer {
 public:
  using Take = decltype(SocketHandler::take);

  /// Listens from here on. `control` must outlive the server. `view` receives the connections of requests below
  /// /view/ while control.viewer() is ready. Throws Error(usage) if other machines can reach the address and there is
  /// no token, Error(io) if the server cannot listen on an address.
  ControlServer(boost::asio::io_context& io, const ControlServerSettings& settings, Control& control,
                const Take& view = nullptr);

  std::uint16_t port() const { return http_.port(); }

 private:
  HttpServer http_;
  std::optional<HttpServer> control_socket_;
};

}  // namespace weir
