// The WebSocket of one viewer: reads messages, writes texts and pictures, and ends if the client leaves, falls silent,
// sends too much or takes nothing. The queue to be written is bounded to one picture and a few texts. Used only on the
// io_context's thread; keeps itself alive while it waits.
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

/// The limits on what one viewer may use of the server.
struct ViewerLimits {
  std::size_t message_bytes = 64 << 10;      ///< largest message of a client; a larger message ends the connection
  double messages_per_s = 300;               ///< a higher rate ends the connection
  double burst = 600;                        ///< messages above that rate that are allowed in a burst
  std::size_t texts = 64;                    ///< texts waiting to be written; more end the connection
  std::chrono::milliseconds idle{20'000};    ///< longest time without a sign of life; answered pings count
  std::chrono::milliseconds taking{30'000};  ///< longest time until a picture is taken
};

class ViewerSocket : public std::enable_shared_from_this<ViewerSocket> {
 public:
  using Socket = boost::asio::generic::stream_protocol::socket;

  struct Events {
    std::function<void()> opened;
    std::function<void(std::string_view text)> message;
    /// Called once when the connection is over for any reason except close_now(); `why` is empty if the client left.
    std::function<void(std::string_view why)> ended;
  };

  ViewerSocket(Socket socket, const ViewerLimits& limits, Events events);

  /// Answers the request; `protocol` is the agreed protocol, or empty.
  void accept(const UpgradeRequest& request, const std::string& protocol);
  void send_text(std::string text);
  /// Sends a picture. The next picture may be sent after taken().
  void send_picture(std::string message);
  /// Tells that the client has the picture.
  void taken();
  /// Closes the connection with a code of RFC 6455 and the reason `why`.
  void close(boost::beast::websocket::close_code code, std::string_view why);
  /// Closes the connection at once; no event comes afterwards.
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
  std::deque<Outgoing> outgoing_;  // the first message is being written
  bool open_ = false;
  bool closing_ = false;
  bool ended_ = false;
  double allowance_;  // messages
  std::chrono::steady_clock::time_point counted_ = std::chrono::steady_clock::now();
};

}  // namespace weir
