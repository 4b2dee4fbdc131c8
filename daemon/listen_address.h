// Where the control server listens, and where its clients find it: "HOST:PORT".
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace weir {

struct ListenAddress {
  std::string host;  ///< an IPv4 or IPv6 address, or a name; no brackets
  std::uint16_t port = 0;

  /// "HOST:PORT", an IPv6 address in brackets.
  std::string text() const;
};

/// "127.0.0.1:8470", "[::1]:8470", "localhost:0". Throws Error(usage) naming `text` where it is no such pair.
ListenAddress parse_listen_address(std::string_view text);

/// Whether `host` can only be reached from this machine: "localhost", 127.0.0.0/8, ::1. Any other name counts as
/// reachable from elsewhere, whatever it resolves to now.
bool is_loopback(std::string_view host);

}  // namespace weir
