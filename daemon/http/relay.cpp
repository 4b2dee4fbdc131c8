#include "daemon/http/relay.h"

#include <fcntl.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/error.hpp>
#include <boost/asio/write.hpp>
#include <type_traits>
#include <utility>

#include "daemon/http/http_message.h"
#include "daemon/http/timer.h"
#include "format/base/text.h"

namespace weir {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;

std::string refusal() {
  const HttpResponse response =
      error_response(502, "the viewer does not answer; open it again from the service's page");
  return cat("HTTP/1.1 502 Bad Gateway\r\nContent-Type: ", response.content_type,
             "\r\nContent-Length: ", response.body.size(), "\r\nConnection: close\r\n\r\n", response.body);
}

}  // namespace

Relay::Relay(Client client, std::string request, Ended ended, std::chrono::milliseconds taking)
    : client_(std::move(client)),
      server_(client_.get_executor()),
      limit_(client_.get_executor()),
      taken_(client_.get_executor()),
      taking_(taking),
      request_(std::move(request)),
      ended_(std::move(ended)) {}

void Relay::start(const asio::ip::tcp::endpoint& server, std::optional<std::chrono::milliseconds> limit) {
  if (limit) end_within(limit_, *limit);
  error_code unopened;  // async_connect reports the error
  server_.open(server.protocol(), unopened);
  if (!unopened)
    ::fcntl(server_.native_handle(), F_SETFD, FD_CLOEXEC);  // child processes (conversions) must not inherit it
  server_.async_connect(server, [self = shared_from_this()](const error_code& error) {
    if (self->closed_) return;
    if (error) return self->refuse();
    error_code ignored;
    self->server_.set_option(asio::ip::tcp::no_delay(true), ignored);
    asio::async_write(self->server_, asio::buffer(self->request_), [self](const error_code& failure, std::size_t) {
      if (self->closed_) return;
      if (failure) return self->refuse();
      self->pump(self->client_, self->server_, self->to_server_);
      self->pump(self->server_, self->client_, self->to_client_);
    });
  });
}

// Reads the next piece when the last one is written, so that a slow reader slows the other side and fills no memory.
// While a client does not read, the end of the server goes unnoticed, so the write to the client has a time limit.
template <typename From, typename To>
void Relay::pump(From& from, To& to, Piece& piece) {
  constexpr bool kToClient = std::is_same_v<To, Client>;
  from.async_read_some(asio::buffer(piece),
                       [self = shared_from_this(), &from, &to, &piece](const error_code& error, std::size_t bytes) {
                         if (self->closed_) return;
                         if (error == asio::error::eof) return self->finish(to);
                         if (error) return self->end();
                         if constexpr (kToClient) self->end_within(self->taken_, self->taking_);
                         asio::async_write(to, asio::buffer(piece, bytes),
                                           [self, &from, &to, &piece](const error_code& failure, std::size_t) {
                                             if (self->closed_) return;
                                             if (failure) return self->end();
                                             if constexpr (kToClient)
                                               self->taken_.expires_at(asio::steady_timer::time_point::max());
                                             self->pump(from, to, piece);
                                           });
                       });
}

// One side has finished sending. It may still receive, but only for a limited time, because a client that is gone
// sends no notice.
template <typename To>
void Relay::finish(To& to) {
  if (++finished_ == 2) return end();
  error_code ignored;
  to.shutdown(asio::socket_base::shutdown_send, ignored);
  if (limit_.expiry() <= std::chrono::steady_clock::now()) end_within(limit_, kHalfClosed);
}

void Relay::end_within(asio::steady_timer& timer, std::chrono::milliseconds limit) {
  timer.expires_after(limit);
  timer.async_wait([self = shared_from_this(), &timer](const error_code& error) {
    if (!error && !self->closed_ && is_over(timer)) self->end();
  });
}

void Relay::refuse() {
  request_ = refusal();
  asio::async_write(client_, asio::buffer(request_), [self = shared_from_this()](const error_code&, std::size_t) {
    if (!self->closed_) self->end();
  });
}

void Relay::close() {
  closed_ = true;
  error_code ignored;
  limit_.cancel(ignored);
  taken_.cancel(ignored);
  client_.close(ignored);
  server_.close(ignored);
}

void Relay::end() {
  if (closed_) return;
  const auto self = shared_from_this();
  close();
  ended_(*this);
}

}  // namespace weir
