// One connection: reads a request, has it answered, writes the answer, and repeats this until the client leaves,
// breaks the rules, takes too long or is handed over as a WebSocket. Requests of one connection are answered in
// order, pipelined or not. The session keeps itself alive while it waits. One thread: the io_context's.
#pragma once

#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>

#include "daemon/http/http_limits.h"
#include "daemon/http/http_message.h"
#include "daemon/http/socket_handler.h"

namespace weir {

class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  /// The present activity of the connection.
  enum class Phase { idle, receiving, draining, responding };
  using Clock = std::chrono::steady_clock;

  /// `ended` is called once, when the connection is closed for any reason except close().
  HttpSession(boost::asio::generic::stream_protocol::socket socket, bool local, const HttpLimits& limits,
              HttpHandler handler, SocketHandler sockets, std::function<void(HttpSession&)> ended);

  void start();
  /// Closes the connection at once; neither the handler nor `ended` is called afterwards.
  void close();

  Phase phase() const { return phase_; }
  /// Returns since when it waits for its next request: since it was accepted or its last answer was received.
  Clock::time_point waiting_since() const { return waiting_since_; }
  /// Returns whether the client is on this machine.
  bool local() const { return local_; }

 private:
  void enter(Phase phase, std::chrono::milliseconds limit);
  void await_request();
  void receive(void (HttpSession::*next)());
  void begin_request();
  void parse();
  void refuse(const boost::system::error_code& error);
  void refuse(unsigned status, const char* message);
  void answer();
  HttpResponse answer_to(const HttpRequest& request) const;
  void hand_over();
  void respond(HttpResponse response, bool keep_alive);
  void drain();
  void discard_more();
  void on_timeout();
  void end();

  bool local_;
  boost::asio::generic::stream_protocol::socket socket_;
  boost::asio::steady_timer timer_;
  const HttpLimits limits_;
  HttpHandler handler_;
  SocketHandler sockets_;
  std::function<void(HttpSession&)> ended_;
  boost::beast::flat_buffer buffer_;
  std::optional<boost::beast::http::request_parser<boost::beast::http::string_body>> parser_;
  std::optional<boost::beast::http::response<boost::beast::http::string_body>> response_;
  Phase phase_ = Phase::idle;
  Clock::time_point waiting_since_ = Clock::now();
  std::size_t header_bytes_ = 0;  ///< bytes of the request's header so far, with its first line
  bool head_ = false;             ///< the request is HEAD: its response has no body
  bool timed_out_ = false;        ///< on_timeout gave the request up
  bool closed_ = false;
};

}  // namespace weir
