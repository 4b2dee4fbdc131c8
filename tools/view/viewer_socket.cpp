#include "tools/view/viewer_socket.h"

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <utility>

namespace weir {
namespace {

namespace websocket = boost::beast::websocket;
using boost::system::error_code;

constexpr std::chrono::seconds kHandshake{10};  // time for the client's part in opening and closing
constexpr std::size_t kLongestReason = 120;     // bytes; RFC 6455 has room for 123

}  // namespace

ViewerSocket::ViewerSocket(Socket socket, const ViewerLimits& limits, Events events)
    : stream_(std::move(socket)),
      taking_(stream_.get_executor()),
      limits_(limits),
      events_(std::move(events)),
      buffer_(limits.message_bytes),
      allowance_(limits.burst) {}

void ViewerSocket::accept(const UpgradeRequest& request, const std::string& protocol) {
  stream_.set_option(websocket::stream_base::timeout{kHandshake, limits_.idle, true});
  stream_.set_option(websocket::stream_base::decorator([protocol](websocket::response_type& response) {
    if (!protocol.empty()) response.set(boost::beast::http::field::sec_websocket_protocol, protocol);
  }));
  stream_.read_message_max(limits_.message_bytes);
  stream_.auto_fragment(false);
  stream_.async_accept(request, [self = shared_from_this()](const error_code& error) {
    if (self->ended_) return;
    if (error) return self->end("");
    self->open_ = true;
    self->events_.opened();
    if (!self->ended_) self->read();
  });
}

void ViewerSocket::read() {
  stream_.async_read(buffer_, [self = shared_from_this()](const error_code& error, std::size_t) {
    if (self->ended_) return;
    if (error == websocket::error::message_too_big || error == websocket::error::buffer_overflow) {
      return self->end("it sent a message that is too large");
    }
    if (error) return self->end(error == boost::beast::error::timeout ? "it gave no sign of life" : "");
    if (self->closing_) {  // later messages are ignored
      self->buffer_.consume(self->buffer_.size());
      return self->read();
    }
    if (!self->may_send_more()) return self->close(websocket::close_code::policy_error, "too many messages");
    const auto data = self->buffer_.data();
    if (!self->stream_.got_text()) {
      return self->close(websocket::close_code::unknown_data, "messages to this server are texts");
    }
    self->events_.message({static_cast<const char*>(data.data()), data.size()});
    if (self->ended_) return;
    self->buffer_.consume(self->buffer_.size());
    self->read();
  });
}

// Token bucket that fills at the allowed rate.
bool ViewerSocket::may_send_more() {
  const auto now = std::chrono::steady_clock::now();
  const double passed_s = std::chrono::duration<double>(now - counted_).count();
  counted_ = now;
  allowance_ = std::min(limits_.burst, allowance_ + passed_s * limits_.messages_per_s) - 1;
  return allowance_ >= 0;
}

void ViewerSocket::send_text(std::string text) { send({std::move(text), false}); }

void ViewerSocket::send_picture(std::string message) {
  taking_.expires_after(limits_.taking);
  taking_.async_wait([self = shared_from_this()](const error_code& error) {
    // The timer was set anew if it fired just before the picture was taken or the next picture was sent.
    if (error || self->ended_ || self->taking_.expiry() > std::chrono::steady_clock::now()) return;
    self->end("it takes no pictures");
  });
  send({std::move(message), true});
}

void ViewerSocket::taken() {
  taking_.expires_at(std::chrono::steady_clock::time_point::max());  // cancels the wait, too
}

void ViewerSocket::send(Outgoing message) {
  if (!open_ || closing_ || ended_) return;
  if (outgoing_.size() > limits_.texts) return end("it does not read what it is sent");
  outgoing_.push_back(std::move(message));
  if (outgoing_.size() == 1) write();
}

void ViewerSocket::write() {
  stream_.text(!outgoing_.front().binary);
  stream_.async_write(boost::asio::buffer(outgoing_.front().bytes),
                      [self = shared_from_this()](const error_code& error, std::size_t) {
                        if (self->ended_) return;
                        if (error) return self->end("");
                        self->outgoing_.pop_front();
                        if (!self->outgoing_.empty()) self->write();
                      });
}

void ViewerSocket::close(websocket::close_code code, std::string_view why) {
  if (closing_ || ended_) return;
  closing_ = true;
  const std::string_view reason = why.substr(0, kLongestReason);
  stream_.async_close({code, boost::beast::string_view(reason.data(), reason.size())},
                      [self = shared_from_this(), text = std::string(why)](const error_code&) { self->end(text); });
}

void ViewerSocket::close_now() {
  if (ended_) return;
  ended_ = true;
  error_code ignored;
  taking_.cancel(ignored);
  boost::beast::get_lowest_layer(stream_).close(ignored);
}

void ViewerSocket::end(std::string_view why) {
  if (ended_) return;
  close_now();
  events_.ended(why);
}

}  // namespace weir
