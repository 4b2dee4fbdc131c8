// Where the control server listens, and where its clients find it: "HOST:PORT" of TCP, or "unix:PATH", a socket in the
// file system.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace weir {

struct ListenAddress {
  std::string host;  ///< an IPv4 or IPv6 address, or a name; no brackets
  std::uint16_t port = 0;
  std::string path{};  ///< of a Unix socket; then host and port say nothing

  bool is_unix() const { return !path.empty(); }
  /// "HOST:PORT", an IPv6 address in brackets; or "unix:PATH".
  std::string text() const;
};

/// "127.0.0.1:8470", "[::1]:8470", "localhost:0", "unix:/run/weir.sock". Throws Error(usage) naming `text` where it is
/// none of these, beginning with `option`, "--listen", where that is given.
ListenAddress parse_listen_address(std::string_view text, std::string_view option = {});

/// Bytes of the path of a Unix socket, at most: the system takes 107, and a ".new" is appended for a moment.
inline constexpr std::size_t kLongestSocketPath = 103;

/// Whether `host` can only be reached from this machine: "localhost", 127.0.0.0/8, ::1. Any other name counts as
/// reachable from elsewhere, whatever it resolves to now.
bool is_loopback(std::string_view host);

}  // namespace weir
