#include "daemon/http/http_server.h"

#include <algorithm>
#include <boost/asio/steady_timer.hpp>
#include <tuple>
#include <utility>
#include <vector>

#include "daemon/http/http_session.h"
#include "daemon/http/listening_socket.h"

namespace weir {
namespace {

using boost::system::error_code;

constexpr std::chrono::milliseconds kAcceptAgain{100};  // wait after a failure, for example when no descriptor is left

}  // namespace

class HttpServer::Listener : public std::enable_shared_from_this<Listener> {
 public:
  Listener(boost::asio::io_context& io, const ListenAddress& address, const HttpLimits& limits, HttpHandler handler,
           SocketHandler sockets)
      : listening_(io, address),
        retry_(io),
        limits_(limits),
        handler_(std::move(handler)),
        sockets_(std::move(sockets)) {}

  void accept() {
    listening_.acceptor().async_accept([self = shared_from_this()](const error_code& error, StreamSocket socket) {
      if (self->closed_) return;
      if (error) return self->accept_later();
      self->add(std::move(socket));
      self->accept();
    });
  }

  void close() {
    closed_ = true;
    error_code ignored;
    listening_.close();
    retry_.cancel(ignored);
    for (const auto& session : sessions_) session->close();
    sessions_.clear();
  }

  std::uint16_t port() const { return listening_.port(); }

 private:
  void add(StreamSocket socket) {
    const bool local = prepare(socket);
    while (sessions_.size() >= std::max<std::size_t>(limits_.connections, 1)) make_room(local);
    sessions_.push_back(std::make_shared<HttpSession>(std::move(socket), local, limits_, handler_, sockets_,
                                                      [this](HttpSession& ended) { remove(ended); }));
    sessions_.back()->start();
  }

  // Closes the connection that has waited longest for a complete request, whether it sends slowly or not at all: a
  // new connection takes precedence over idle ones. Connections that are being answered are closed last.
  // `local_share` connections of this machine, which asks for the service's health, are never closed for other
  // clients.
  void make_room(bool for_local) {
    const auto locals = static_cast<std::size_t>(
        std::count_if(sessions_.begin(), sessions_.end(), [](const auto& session) { return session->local(); }));
    const bool local_goes = for_local ? locals >= limits_.local_share : locals > limits_.local_share;
    const auto rank = [&](const std::shared_ptr<HttpSession>& session) {
      const bool answered = session->phase() == HttpSession::Phase::responding;
      return std::tuple(session->local() && !local_goes, answered, session->waiting_since());
    };
    const auto longest = std::min_element(sessions_.begin(), sessions_.end(),
                                          [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
    (*longest)->close();
    sessions_.erase(longest);
  }

  void remove(HttpSession& ended) {
    std::erase_if(sessions_, [&](const auto& session) { return session.get() == &ended; });
  }

  void accept_later() {
    if (!sessions_.empty()) make_room(false);
    retry_.expires_after(kAcceptAgain);
    retry_.async_wait([self = shared_from_this()](const error_code& error) {
      if (!error && !self->closed_) self->accept();
    });
  }

  ListeningSocket listening_;
  boost::asio::steady_timer retry_;
  const HttpLimits limits_;
  HttpHandler handler_;
  SocketHandler sockets_;
  std::vector<std::shared_ptr<HttpSession>> sessions_;
  bool closed_ = false;
};

HttpServer::HttpServer(boost::asio::io_context& io, const ListenAddress& address, const HttpLimits& limits,
                       HttpHandler handler, SocketHandler sockets)
    : listener_(std::make_shared<Listener>(io, address, limits, std::move(handler), std::move(sockets))) {
  listener_->accept();
}

HttpServer::~HttpServer() { listener_->close(); }

std::uint16_t HttpServer::port() const { return listener_->port(); }

}  // namespace weir
