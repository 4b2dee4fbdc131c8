// Relays one client's connection to another server. Sends the server a request, and then passes bytes in both
// directions until both sides have finished or the client stops reading. Holds at most one piece per direction. One
// thread: the io_context's. Keeps itself alive while it waits.
#pragma once

#include <array>
#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace weir {

class Relay : public std::enable_shared_from_this<Relay> {
 public:
  using Client = boost::asio::generic::stream_protocol::socket;
  using Ended = std::function<void(Relay&)>;

  /// Limit for a client to read a piece; the same as the viewer's limit for sending a picture.
  static constexpr std::chrono::seconds kTaking{30};

  /// `request` is sent to the server first. `ended` is called once, for any end except close(). The connection ends
  /// if a client does not read a piece within `taking`.
  Relay(Client client, std::string request, Ended ended, std::chrono::milliseconds taking = kTaking);

  /// Connects to `server`; if this fails, the client gets a 502. If `limit` is given, both connections are closed
  /// after this time in any case.
  void start(const boost::asio::ip::tcp::endpoint& server, std::optional<std::chrono::milliseconds> limit);
  /// Closes both connections at once.
  void close();

 private:
  static constexpr std::size_t kPieceBytes = 32 << 10;
  static constexpr std::chrono::seconds kHalfClosed{10};  // limit after one side has finished
  using Piece = std::array<char, kPieceBytes>;

  template <typename From, typename To>
  void pump(From& from, To& to, Piece& piece);
  template <typename To>
  void finish(To& to);
  void refuse();
  void end_within(boost::asio::steady_timer& timer, std::chrono::milliseconds limit);
  void end();

  Client client_;
  boost::asio::ip::tcp::socket server_;
  boost::asio::steady_timer limit_;
  boost::asio::steady_timer taken_;  // runs while bytes are written to the client
  const std::chrono::milliseconds taking_;
  std::string request_;  // bytes to write completely: the request, or the refusal
  Ended ended_;
  Piece to_server_{};
  Piece to_client_{};
  int finished_ = 0;  // number of directions that have ended
  bool closed_ = false;
};

}  // namespace weir
