// One viewer's WebSocket: reads messages, writes texts and pictures, ends where the client leaves, falls silent, sends
// too much or takes nothing. What waits to be written is bounded: one picture, and a few texts. One thread, the
// io_context's; keeps itself alive while it waits.
#pragma once

#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "daemon/http/socket_handler.h"

namespace weir {

/// What one viewer may take of the server.
struct ViewerLimits {
  std::size_t message_bytes = 64 << 10;      ///< of one message of a client; more ends its connection
  double messages_per_s = 300;               ///< likewise
  double burst = 600;                        ///< messages above that rate
  std::size_t texts = 64;                    ///< that wait to be written; more ends the connection
  std::chrono::milliseconds idle{20'000};    ///< without a sign of life, pings answered included
  std::chrono::milliseconds taking{30'000};  ///< for a picture to be taken
};

class ViewerSocket : public std::enable_shared_from_this<ViewerSocket> {
 public:
  using Socket = boost::asio::generic::stream_protocol::socket;

  struct Events {
    std::function<void()> opened;
    std::function<void(std::string_view text)> message;
    /// Once, when the connection is over for whatever reason but close_now(); `why` is empty where the client left.
    std::function<void(std::string_view why)> ended;
  };

  ViewerSocket(Socket socket, const ViewerLimits& limits, Events events);

  /// Answers the request; `protocol` is the one it agrees to, or empty.
  void accept(const UpgradeRequest& request, const std::string& protocol);
  void send_text(std::string text);
  /// One at a time: the next one after taken().
  void send_picture(std::string message);
  /// The client has the picture.
  void taken();
  /// Says why, with a code of RFC 6455, and ends.
  void close(boost::beast::websocket::close_code code, std::string_view why);
  /// At once; no event comes from here on.
  void close_now();

 private:
  struct Outgoing {
    std::string bytes;
    bool binary = false;
  };

  void read();
  void send(Outgoing message);
  void write();
  void end(std::string_view why);
  bool may_send_more();

  boost::beast::websocket::stream<Socket> stream_;
  boost::asio::steady_timer taking_;
  const ViewerLimits limits_;
  Events events_;
  boost::beast::flat_buffer buffer_;
  std::deque<Outgoing> outgoing_;  // the first one is being written
  bool open_ = false;
  bool closing_ = false;
  bool ended_ = false;
  double allowance_;  // messages
  std::chrono::steady_clock::time_point counted_ = std::chrono::steady_clock::now();
};

}  // namespace weir
