#include "daemon/http_session.h"

#include <spdlog/spdlog.h>

#include <boost/asio/buffer.hpp>
#include <boost/beast/core/buffer_traits.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <exception>
#include <utility>

namespace weir {
namespace {

namespace http = boost::beast::http;
using boost::system::error_code;

// Beyond the longest header, so that its limit is met before the buffer's; a body moves on into its string.
constexpr std::size_t kBufferBytes = 16 << 10;

struct Refusal {
  unsigned status;
  const char* message;
};

// What a request that the parser refused is told.
Refusal refusal(const error_code& error) {
  if (error == http::error::header_limit || error == http::error::buffer_overflow) {
    return {431, "the request's header is too large"};
  }
  if (error == http::error::body_limit) return {413, "the request's body is too large"};
  return {400, "this is no HTTP/1.1 request"};
}

std::string text_of(boost::beast::string_view view) { return {view.data(), view.size()}; }

}  // namespace

HttpSession::HttpSession(boost::asio::ip::tcp::socket socket, const HttpLimits& limits, HttpHandler handler,
                         std::function<void(HttpSession&)> ended)
    : socket_(std::move(socket)),
      timer_(socket_.get_executor()),
      limits_(limits),
      handler_(std::move(handler)),
      ended_(std::move(ended)),
      buffer_(kBufferBytes) {}

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

// A new phase: its clock starts.
void HttpSession::enter(Phase phase, std::chrono::milliseconds limit) {
  phase_ = phase;
  since_ = Clock::now();
  timer_.expires_after(limit);
  timer_.async_wait([self = shared_from_this()](const error_code& error) {
    // A wait that had expired when the next phase began comes here without an error, too.
    if (!error && !self->closed_ && self->timer_.expiry() <= Clock::now()) self->on_timeout();
  });
}

void HttpSession::on_timeout() {
  if (phase_ != Phase::receiving) return end();
  timed_out_ = true;  // on_request tells the client
  error_code ignored;
  socket_.cancel(ignored);
}

void HttpSession::await_request() {
  if (buffer_.size() > 0) return read_request();  // pipelined
  enter(Phase::idle, limits_.idle);
  socket_.async_read_some(buffer_.prepare(512),
                          [self = shared_from_this()](const error_code& error, std::size_t bytes) {
                            if (self->closed_) return;
                            if (error) return self->end();
                            self->buffer_.commit(bytes);
                            self->read_request();
                          });
}

void HttpSession::read_request() {
  timed_out_ = false;
  enter(Phase::receiving, limits_.request);
  parser_.emplace();
  parser_->header_limit(limits_.header_bytes);
  parser_->body_limit(limits_.body_bytes);
  http::async_read(socket_, buffer_, *parser_, [self = shared_from_this()](const error_code& error, std::size_t) {
    if (!self->closed_) self->on_request(error);
  });
}

void HttpSession::on_request(const error_code& error) {
  if (!error) return answer();
  head_ = false;
  if (timed_out_) return respond(error_response(408, "the request took too long to arrive"), false);
  // Only what the parser said is worth an answer; otherwise the client is gone.
  if (error.category() != make_error_code(http::error::bad_method).category() || error == http::error::end_of_stream ||
      error == http::error::partial_message) {
    return end();
  }
  const Refusal refused = refusal(error);
  respond(error_response(refused.status, refused.message), false);
}

void HttpSession::answer() {
  const http::request<http::string_body>& message = parser_->get();
  head_ = message.method() == http::verb::head;
  const auto hosts = message.count(http::field::host);
  if (hosts > 1 || (hosts == 0 && message.version() >= 11)) {
    return respond(error_response(400, "a request needs one Host header"), false);
  }
  HttpRequest request;
  request.method = text_of(message.method_string());
  request.target = text_of(message.target());
  request.host = text_of(message[http::field::host]);
  request.authorization = text_of(message[http::field::authorization]);
  request.content_type = text_of(message[http::field::content_type]);
  request.marked = message.count("X-Weir") > 0;
  request.body = message.body();
  const bool keep_alive = message.keep_alive();
  HttpResponse response;
  try {
    response = handler_(request);
  } catch (const std::exception& error) {
    spdlog::error("http: {} {}: {}", request.method, request.target, error.what());
    response = error_response(500, error.what());
  }
  respond(std::move(response), keep_alive);
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

// Closing a socket with unread bytes resets the connection, and the client may lose the response: so the sending
// half is closed, and what still comes is thrown away for a moment.
void HttpSession::drain() {
  error_code ignored;
  socket_.shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
  buffer_.consume(buffer_.size());
  enter(Phase::draining, limits_.linger);
  discard_more();
}

void HttpSession::discard_more() {
  socket_.async_read_some(buffer_.prepare(kBufferBytes),
                          [self = shared_from_this()](const error_code& error, std::size_t) {
                            if (self->closed_) return;
                            if (error) return self->end();
                            self->discard_more();
                          });
}

}  // namespace weir
