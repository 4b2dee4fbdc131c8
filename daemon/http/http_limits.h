// What one client may take of the server's memory, time and descriptors.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace weir {

struct HttpLimits {
  std::uint32_t header_bytes = 8 << 10;        ///< request line and headers; more is 431
  std::uint64_t body_bytes = 64 << 10;         ///< more is 413
  std::chrono::milliseconds request{10'000};   ///< from a request's first byte to its last; more is 408
  std::chrono::milliseconds idle{30'000};      ///< between requests; then the connection is closed
  std::chrono::milliseconds response{30'000};  ///< for the client to take a response; then it is closed
  std::chrono::milliseconds linger{1'000};     ///< for the client to read a last response while it still sends
  std::size_t connections = 512;               ///< at once; for one more, the one waiting longest is closed
  std::size_t local_share = 32;                ///< of those, kept for this machine: others close none of them
};

}  // namespace weir
