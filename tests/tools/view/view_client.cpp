#include "tests/tools/view/view_client.h"

#include <boost/asio/connect.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/error.hpp>

namespace weir {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;

asio::ip::tcp::endpoint loopback(std::uint16_t port) { return {asio::ip::address_v4::loopback(), port}; }

}  // namespace

ViewClient::ViewClient(std::uint16_t port, const ClientHeaders& headers) {
  stream_.next_layer().connect(loopback(port));
  stream_.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
    request.set(http::field::host, headers.host);
    if (!headers.origin.empty()) request.set(http::field::origin, headers.origin);
    if (!headers.protocols.empty()) request.set(http::field::sec_websocket_protocol, headers.protocols);
  }));
  stream_.read_message_max(64 << 20);
  stream_.handshake(headers.host, headers.target);
}

void ViewClient::send_text(const std::string& text) {
  stream_.text(true);
  stream_.write(asio::buffer(text));
}

void ViewClient::show(std::int64_t id, bool moving, const nlohmann::json& more) {
  nlohmann::json view{{"type", "view"},   {"id", id}, {"scene", "mode = \"dvr\"\n"}, {"width", 64}, {"height", 48},
                      {"moving", moving}, {"step", 0}};
  if (more.is_object()) view.update(more);
  send(view);
}

// Reads until a message is complete or the time is over. After a timeout the connection is broken, because a message
// may be half read.
std::optional<ViewClient::Message> ViewClient::read(std::chrono::milliseconds wait) {
  if (broken_) return std::nullopt;
  boost::beast::flat_buffer buffer;
  std::optional<error_code> result;
  stream_.async_read(buffer, [&](const error_code& error, std::size_t) { result = error; });
  io_.restart();
  io_.run_for(wait);
  if (!result) {
    broken_ = true;
    error_code ignored;
    stream_.next_layer().close(ignored);
    io_.restart();
    io_.run();
    return std::nullopt;
  }
  if (*result) {
    broken_ = true;
    return std::nullopt;
  }
  return Message{stream_.got_binary(), {static_cast<const char*>(buffer.data().data()), buffer.size()}};
}

std::optional<ReceivedFrame> ViewClient::frame(std::chrono::milliseconds wait) {
  const auto end = Clock::now() + wait;
  while (const auto message = read(std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()))) {
    if (!message->binary) {
      texts.push_back(nlohmann::json::parse(message->bytes));
      continue;
    }
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      length |= static_cast<std::size_t>(static_cast<unsigned char>(message->bytes.at(i))) << (8 * i);
    }
    return ReceivedFrame{nlohmann::json::parse(message->bytes.substr(4, length)), message->bytes.substr(4 + length)};
  }
  return std::nullopt;
}

std::optional<nlohmann::json> ViewClient::text(const std::string& type, std::chrono::milliseconds wait) {
  for (auto seen = texts.begin(); seen != texts.end(); ++seen) {
    if ((*seen)["type"] != type) continue;
    nlohmann::json found = *seen;
    texts.erase(seen);
    return found;
  }
  const auto end = Clock::now() + wait;
  while (const auto message = read(std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()))) {
    if (message->binary) continue;
    nlohmann::json found = nlohmann::json::parse(message->bytes);
    if (found["type"] == type) return found;
  }
  return std::nullopt;
}

std::optional<ReceivedFrame> ViewClient::refined(std::int64_t view, int samples) {
  for (;;) {
    auto found = frame();
    if (!found) return std::nullopt;
    taken(*found);
    if (found->header["view"] == view && found->header["samples"] >= samples && !found->header["moving"]) return found;
  }
}

bool ViewClient::ended(std::chrono::milliseconds wait) {
  const auto end = Clock::now() + wait;
  while (!broken_ && Clock::now() < end)
    read(std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()));
  return broken_ && Clock::now() < end;
}

std::string upgrade_answer(std::uint16_t port, const ClientHeaders& headers) {
  asio::io_context io;
  asio::ip::tcp::socket socket(io);
  socket.connect(loopback(port));
  http::request<http::empty_body> request(http::verb::get, headers.target, 11);
  request.set(http::field::host, headers.host);
  request.set(http::field::connection, "Upgrade");
  request.set(http::field::upgrade, "websocket");
  request.set(http::field::sec_websocket_key, "dGhlIHNhbXBsZSBub25jZQ==");
  request.set(http::field::sec_websocket_version, "13");
  if (!headers.origin.empty()) request.set(http::field::origin, headers.origin);
  if (!headers.protocols.empty()) request.set(http::field::sec_websocket_protocol, headers.protocols);
  http::write(socket, request);
  boost::beast::flat_buffer buffer;
  http::response_parser<http::string_body> parser;
  http::read_header(socket, buffer, parser);
  const int status = static_cast<int>(parser.get().result_int());
  if (status == 101) return "101";
  http::read(socket, buffer, parser);
  return std::to_string(status) + " " + parser.get().body();
}

std::pair<int, std::string> get(std::uint16_t port, const std::string& target, const ClientHeaders& headers,
                                const std::string& authorization) {
  asio::io_context io;
  asio::ip::tcp::socket socket(io);
  socket.connect(loopback(port));
  http::request<http::empty_body> request(http::verb::get, target, 11);
  request.set(http::field::host, headers.host);
  if (!authorization.empty()) request.set(http::field::authorization, authorization);
  http::write(socket, request);
  boost::beast::flat_buffer buffer;
  http::response<http::string_body> response;
  http::read(socket, buffer, response);
  return {static_cast<int>(response.result_int()), response.body()};
}

}  // namespace weir
