#include "daemon/http/http_session.h"

#include <spdlog/spdlog.h>

#include <boost/asio/buffer.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <exception>
#include <utility>

#include "daemon/http/timer.h"
#include "daemon/store/sqlite.h"

namespace weir {
namespace {

namespace http = boost::beast::http;
using boost::system::error_code;

// The buffer holds at most the bytes that are not parsed yet: a part of a header or of a chunk header. Bytes of a
// body move on at once.
constexpr std::size_t kReadBytes = 4 << 10;
constexpr std::size_t kSpareBytes = 8 << 10;

std::string text_of(boost::beast::string_view view) { return {view.data(), view.size()}; }

}  // namespace

HttpSession::HttpSession(boost::asio::generic::stream_protocol::socket socket, bool local, const HttpLimits& limits,
                         HttpHandler handler, SocketHandler sockets, std::function<void(HttpSession&)> ended)
    : local_(local),
      socket_(std::move(socket)),
      timer_(socket_.get_executor()),
      limits_(limits),
      handler_(std::move(handler)),
      sockets_(std::move(sockets)),
      ended_(std::move(ended)),
      buffer_(limits.header_bytes + kSpareBytes) {}

void HttpSession::start() { await_request(); }

void HttpSession::close() {
  if (closed_) return;
  closed_ = true;
  error_code ignored;
  timer_.cancel(ignored);
  socket_.close(ignored);
}

void HttpSession::end() {
  if (closed_) return;
  close();
  ended_(*this);
}

// Begins a phase and starts its time limit.
void HttpSession::enter(Phase phase, std::chrono::milliseconds limit) {
  phase_ = phase;
  timer_.expires_after(limit);
  timer_.async_wait([self = shared_from_this()](const error_code& error) {
    if (!error && !self->closed_ && is_over(self->timer_)) self->on_timeout();
  });
}

void HttpSession::on_timeout() {
  if (phase_ != Phase::receiving) return end();
  timed_out_ = true;  // receive() tells the client
  error_code ignored;
  socket_.cancel(ignored);
}

void HttpSession::await_request() {
  waiting_since_ = Clock::now();
  if (buffer_.size() > 0) return begin_request();  // the next request is in the buffer already (pipelining)
  enter(Phase::idle, limits_.idle);
  receive(&HttpSession::begin_request);
}

// Appends the received bytes to the buffer and continues with `next`.
void HttpSession::receive(void (HttpSession::*next)()) {
  socket_.async_read_some(buffer_.prepare(kReadBytes),
                          [self = shared_from_this(), next](const error_code& error, std::size_t bytes) {
                            if (self->closed_) return;
                            if (self->timed_out_) return self->refuse(408, "the request took too long to arrive");
                            if (error) return self->end();
                            self->buffer_.commit(bytes);
                            ((*self).*next)();
                          });
}

void HttpSession::begin_request() {
  enter(Phase::receiving, limits_.request);
  header_bytes_ = 0;
  parser_.emplace();
  parser_->header_limit(limits_.header_bytes);
  parser_->body_limit(limits_.body_bytes);
  parse();
}

// Does not use http::async_read: the parser's own limit applies to each piece of a header, so many short fields could
// fill the memory.
void HttpSession::parse() {
  while (!parser_->is_done()) {
    const bool in_header = !parser_->is_header_done();
    error_code error;
    const std::size_t used = parser_->put(boost::asio::const_buffer(buffer_.data()), error);
    buffer_.consume(used);
    if (in_header) header_bytes_ += used;
    if (header_bytes_ > limits_.header_bytes) error = http::error::header_limit;
    if (error && error != http::error::need_more) return refuse(error);
    if (error || (buffer_.size() == 0 && !parser_->is_done())) {
      if (buffer_.size() + kReadBytes > buffer_.max_size()) return refuse(http::error::header_limit);
      return receive(&HttpSession::parse);
    }
  }
  answer();
}

void HttpSession::refuse(const error_code& error) {
  if (error == http::error::header_limit) {
    refuse(431, "the request's header is too large");
  } else if (error == http::error::body_limit) {
    refuse(413, "the request's body is too large");
  } else {
    refuse(400, "this is no HTTP/1.1 request");
  }
}

void HttpSession::refuse(unsigned status, const char* message) {
  head_ = false;
  respond(error_response(status, message), false);
}

void HttpSession::answer() {
  const http::request<http::string_body>& message = parser_->get();
  head_ = message.method() == http::verb::head;
  const auto hosts = message.count(http::field::host);
  if (hosts > 1 || (hosts == 0 && message.version() >= 11)) {
    return refuse(400, "a request needs one Host header");
  }
  if (message.count(http::field::transfer_encoding) > 0 && message[http::field::transfer_encoding] != "chunked") {
    return refuse(501, "this Transfer-Encoding is not known; send the body with a Content-Length, or chunked");
  }
  HttpRequest request;
  request.method = text_of(message.method_string());
  request.target = text_of(message.target());
  request.host = text_of(message[http::field::host]);
  request.authorization = text_of(message[http::field::authorization]);
  request.content_type = text_of(message[http::field::content_type]);
  request.marked = message.count("X-Weir") > 0;
  request.origin = text_of(message[http::field::origin]);
  request.protocols = text_of(message[http::field::sec_websocket_protocol]);
  const bool keep_alive = message.keep_alive();
  request.upgrade = boost::beast::websocket::is_upgrade(message);
  if (sockets_.take && (sockets_.wants ? sockets_.wants(request) : request.upgrade)) {
    try {
      if (auto refused = sockets_.refuse(request)) return respond(*std::move(refused), keep_alive);
    } catch (const std::exception& error) {
      spdlog::error("http: {} {}: {}", request.method, request.target, error.what());
      return respond(error_response(500, error.what()), keep_alive);
    }
    return hand_over();
  }
  respond(answer_to(request), keep_alive);
}

HttpResponse HttpSession::answer_to(const HttpRequest& request) const {
  try {
    return handler_(request);
  } catch (const CorruptDatabase&) {  // a corrupt state file ends the service
    throw;
  } catch (const std::exception& error) {
    spdlog::error("http: {} {}: {}", request.method, request.target, error.what());
    return error_response(500, error.what());
  }
}

// Hands the connection over. The connection lives on, and this session ends.
void HttpSession::hand_over() {
  UpgradeRequest request = parser_->release();
  boost::asio::generic::stream_protocol::socket socket = std::move(socket_);
  const auto self = shared_from_this();
  end();
  try {
    sockets_.take(std::move(socket), std::move(request));
  } catch (const std::exception& error) {  // the connection was destroyed together with its taker
    spdlog::error("http: handed over: {}", error.what());
  }
}

void HttpSession::respond(HttpResponse response, bool keep_alive) {
  response_.emplace(static_cast<http::status>(response.status), 11);
  response_->set(http::field::content_type, response.content_type);
  for (const auto& [name, value] : response.headers) response_->set(name, value);
  response_->keep_alive(keep_alive);
  response_->content_length(response.body.size());
  if (!head_) response_->body() = std::move(response.body);
  enter(Phase::responding, limits_.response);
  http::async_write(socket_, *response_, [self = shared_from_this(), keep_alive](const error_code& error, std::size_t) {
    if (self->closed_) return;
    self->response_.reset();
    self->parser_.reset();
    if (error) return self->end();
    if (keep_alive) return self->await_request();
    self->drain();
  });
}

// Closing a socket with unread bytes resets the connection, and the client may lose the response. So only the sending
// half is closed, and bytes that still arrive are discarded for a moment.
void HttpSession::drain() {
  error_code ignored;
  socket_.shutdown(boost::asio::socket_base::shutdown_send, ignored);
  buffer_.consume(buffer_.size());
  enter(Phase::draining, limits_.linger);
  discard_more();
}

void HttpSession::discard_more() {
  socket_.async_read_some(buffer_.prepare(kReadBytes),
                          [self = shared_from_this()](const error_code& error, std::size_t) {
                            if (self->closed_) return;
                            if (error) return self->end();
                            self->discard_more();
                          });
}

}  // namespace weir
