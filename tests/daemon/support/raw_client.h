// A TCP or Unix socket connection that sends any bytes and returns exactly the bytes that come back.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "format/base/text.h"

namespace weir {

struct RawResponse {
  int status = 0;
  std::string head;  ///< status line and headers
  std::string body;

  /// Returns the value of the header; empty if it is missing.
  std::string header(std::string_view name) const {
    const std::size_t at = head.find(cat("\r\n", name, ": "));
    if (at == std::string::npos) return "";
    const std::size_t begin = at + name.size() + 4;
    return head.substr(begin, head.find("\r\n", begin) - begin);
  }
};

class RawClient {
 public:
  /// Creates a socket that is not connected yet.
  explicit RawClient(int family = AF_INET) : socket_(::socket(family, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    if (socket_ < 0) throw std::system_error(errno, std::generic_category(), "socket");
  }
  explicit RawClient(std::uint16_t port) : RawClient(AF_INET) { connect(port); }
  explicit RawClient(const std::string& path) : RawClient(AF_UNIX) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
      throw std::system_error(errno, std::generic_category(), "connect");
    }
  }
  ~RawClient() {
    if (socket_ >= 0) ::close(socket_);
  }
  RawClient(RawClient&& other) noexcept
      : socket_(std::exchange(other.socket_, -1)), received_(std::move(other.received_)) {}
  RawClient& operator=(RawClient&&) = delete;

  void connect(std::uint16_t port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
      throw std::system_error(errno, std::generic_category(), "connect");
    }
  }

  /// Sends all of `bytes`. Returns false if the server has closed the connection.
  bool send(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t n = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (n < 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(n));
    }
    return true;
  }
  /// Receives one response, by its Content-Length. Its status is 0 if the connection ends or 5 s pass before it is
  /// complete.
  RawResponse receive(bool has_body = true) {
    RawResponse response;
    std::size_t end = 0;
    while ((end = received_.find("\r\n\r\n")) == std::string::npos) {
      if (!more()) return {};
    }
    response.head = received_.substr(0, end);
    received_.erase(0, end + 4);
    const auto length = has_body ? parse_int(response.header("Content-Length")).value_or(0) : 0;
    while (received_.size() < static_cast<std::size_t>(length)) {
      if (!more()) return {};
    }
    response.body = received_.substr(0, static_cast<std::size_t>(length));
    received_.erase(0, static_cast<std::size_t>(length));
    response.status = static_cast<int>(parse_int(response.head.substr(9, 3)).value_or(0));
    return response;
  }
  RawResponse ask(std::string_view request) {
    send(request);
    return receive();
  }
  /// Returns whether the server closes the connection within `limit` without sending more.
  bool closed_within(std::chrono::milliseconds limit) { return received_.empty() && wait(limit) && !more(); }

 private:
  bool wait(std::chrono::milliseconds limit) {
    pollfd entry{socket_, POLLIN, 0};
    return ::poll(&entry, 1, static_cast<int>(limit.count())) == 1;
  }
  bool more() {
    char piece[4096];
    if (!wait(std::chrono::seconds(5))) return false;
    const ssize_t n = ::recv(socket_, piece, sizeof piece, 0);
    if (n > 0) received_.append(piece, static_cast<std::size_t>(n));
    return n > 0;
  }

  int socket_;
  std::string received_;
};

}  // namespace weir
