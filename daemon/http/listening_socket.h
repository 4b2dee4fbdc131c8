// A socket that listens: on an address of TCP, or on a path of the file system
// that only those with the right to write it can connect to.
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

  /// Listens from here on. A host is a literal address or "localhost", port 0 takes a free one. A Unix socket has the
  /// mode 0660 whatever the umask; one that a killed process left at its path is replaced, under a lock on PATH.lock
  /// that is held until close() and left there. Throws Error(usage) for another name, Error(io) where the address
  /// cannot be had.
  ListeningSocket(boost::asio::io_context& io, const ListenAddress& address);
  ~ListeningSocket() { close(); }
  ListeningSocket(const ListeningSocket&) = delete;
  ListeningSocket& operator=(const ListeningSocket&) = delete;

  Acceptor& acceptor() { return acceptor_; }
  /// The port it listens on; 0 for a Unix socket.
  std::uint16_t port() const;
  /// Listens no more. The path of a Unix socket is removed.
  void close();

 private:
  void listen_on_tcp(const ListenAddress& address);
  void listen_on_path(const std::string& path);

  Acceptor acceptor_;
  std::string path_;  ///< that is removed at the end
  Descriptor lock_;   ///< on PATH.lock
};

/// Makes a socket ready that was accepted: child processes do not inherit it, and small answers leave at once. Returns
/// whether its other end is on this machine.
bool prepare(StreamSocket& socket);

}  // namespace weir
