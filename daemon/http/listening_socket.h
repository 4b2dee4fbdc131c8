// A listening socket: on a TCP address, or on a path of the file system, which only users with write permission can
// connect to.
#pragma once

#include <boost/asio/basic_socket_acceptor.hpp>
#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <string>

#include "daemon/config/listen_address.h"
#include "format/io/descriptor.h"

namespace weir {

using StreamSocket = boost::asio::generic::stream_protocol::socket;

class ListeningSocket {
 public:
  using Acceptor = boost::asio::basic_socket_acceptor<boost::asio::generic::stream_protocol>;

  /// Listens from here on. The host is a literal address or "localhost"; port 0 takes a free port. A Unix socket has
  /// mode 0660, whatever the umask. If a killed process left a socket at the path, it is replaced. The lock PATH.lock
  /// is held until close(), and the lock file stays. Throws Error(usage) for another host name or a path that is too
  /// long, Error(io) if it cannot listen on the address.
  ListeningSocket(boost::asio::io_context& io, const ListenAddress& address);
  ~ListeningSocket() { close(); }
  ListeningSocket(const ListeningSocket&) = delete;
  ListeningSocket& operator=(const ListeningSocket&) = delete;

  Acceptor& acceptor() { return acceptor_; }
  /// Returns the port that it listens on; 0 for a Unix socket.
  std::uint16_t port() const;
  /// Stops listening. The path of a Unix socket is removed.
  void close();

 private:
  void listen_on_tcp(const ListenAddress& address);
  void listen_on_path(const std::string& path);

  Acceptor acceptor_;
  std::string path_;  ///< path to remove at the end
  Descriptor lock_;   ///< on PATH.lock
};

/// Prepares an accepted socket: child processes do not inherit it, and small answers are sent at once. Returns
/// whether its other end is on this machine.
bool prepare(StreamSocket& socket);

}  // namespace weir
