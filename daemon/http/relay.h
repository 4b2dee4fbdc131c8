// One client's connection that another server answers: sends it a request, and from then on what one side says goes to
// the other, until both have said all, or the client takes nothing any more. Holds at most a piece of each direction.
// One thread, the io_context's; keeps itself alive while it waits.
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

  /// For a client to take a piece, as long as a viewer waits for a picture to be taken.
  static constexpr std::chrono::seconds kTaking{30};

  /// `request` is what the server is sent first; `ended` is called once, for whatever end but close(). A client that
  /// does not take a piece within `taking` is left.
  Relay(Client client, std::string request, Ended ended, std::chrono::milliseconds taking = kTaking);

  /// Connects to `server`; where that cannot be done, the client is answered 502. After `limit`, where that is given,
  /// both connections are closed, however far they are.
  void start(const boost::asio::ip::tcp::endpoint& server, std::optional<std::chrono::milliseconds> limit);
  /// At once.
  void close();

 private:
  static constexpr std::size_t kPieceBytes = 32 << 10;
  static constexpr std::chrono::seconds kHalfClosed{10};  // after one side has said all
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
  boost::asio::steady_timer taken_;  // runs while the client is written to
  const std::chrono::milliseconds taking_;
  std::string request_;  // what is written whole: the request, or the refusal
  Ended ended_;
  Piece to_server_{};
  Piece to_client_{};
  int finished_ = 0;  // directions
  bool closed_ = false;
};

}  // namespace weir
