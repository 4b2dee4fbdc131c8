// Limits on the memory, time and descriptors that one client may take from the server.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace weir {

struct HttpLimits {
  std::uint32_t header_bytes = 8 << 10;        ///< request line and headers; a larger request gets 431
  std::uint64_t body_bytes = 64 << 10;         ///< a larger body gets 413
  std::chrono::milliseconds request{10'000};   ///< from a request's first byte to its last; a slower request gets 408
  std::chrono::milliseconds idle{30'000};      ///< between requests; afterwards the connection is closed
  std::chrono::milliseconds response{30'000};  ///< to receive a response; then the connection is closed
  std::chrono::milliseconds linger{1'000};     ///< for the client to read a last response while it still sends
  std::size_t connections = 512;  ///< at the same time; for one more, the connection that has waited longest is closed
  std::size_t local_share = 32;   ///< connections reserved for this machine: other clients cannot displace them
};

}  // namespace weir
