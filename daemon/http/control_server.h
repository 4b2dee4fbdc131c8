// The control server, on TCP and on a Unix socket where one is wanted: transport (http_server.h), who may ask
// (access.h) and what is answered (api.h) put together. Lives on the io_context's thread.
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
  std::string token;           ///< bearer token that every request for data must bring; empty: none, loopback only
  std::string control_socket;  ///< path of a Unix socket that needs no token; POST is answered there alone. Empty: none
  HttpLimits limits;
};

class ControlServer {
 public:
  using Take = decltype(SocketHandler::take);

  /// Listens from here on. `control` must outlive the server. `view` has the connections of requests below /view/,
  /// while control.viewer() is ready. Throws Error(usage) for an address that others can reach without a token,
  /// Error(io) where an address cannot be had.
  ControlServer(boost::asio::io_context& io, const ControlServerSettings& settings, Control& control,
                const Take& view = nullptr);

  std::uint16_t port() const { return http_.port(); }

 private:
  HttpServer http_;
  std::optional<HttpServer> control_socket_;
};

}  // namespace weir
