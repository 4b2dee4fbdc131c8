// The address of the control server, for the server and its clients: "HOST:PORT" for TCP, or "unix:PATH" for a socket
// in the file system.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace weir {

struct ListenAddress {
  std::string host;  ///< an IPv4 or IPv6 address, or a name; no brackets
  std::uint16_t port = 0;
  std::string path{};  ///< path of a Unix socket; if set, host and port are unused

  bool is_unix() const { return !path.empty(); }
  /// Returns "HOST:PORT", with an IPv6 address in brackets; or "unix:PATH".
  std::string text() const;
};

/// Parses "127.0.0.1:8470", "[::1]:8470", "localhost:0" or "unix:/run/weir.sock". Throws Error(usage) with `text` in
/// its message if it is none of these. The message begins with `option` ("--listen") if that is given.
ListenAddress parse_listen_address(std::string_view text, std::string_view option = {});

/// The most bytes in the path of a Unix socket: the system accepts 107, and ".new" is appended for a moment.
inline constexpr std::size_t kLongestSocketPath = 103;

/// Returns whether `host` can only be reached from this machine: "localhost", 127.0.0.0/8, ::1. Any other name counts
/// as reachable from other machines, whatever it resolves to.
bool is_loopback(std::string_view host);

}  // namespace weir
