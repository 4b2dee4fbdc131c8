// A viewer without a browser: a blocking WebSocket client with a time limit on each call.
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/view/view_access.h"

namespace weir {

struct ClientHeaders {
  std::string host = "127.0.0.1";
  std::string origin{};  ///< empty: none
  std::string protocols{kViewProtocol};
  std::string target = "/ws";
};

struct ReceivedFrame {
  nlohmann::json header;
  std::string picture;
};

class ViewClient {
 public:
  /// Connects. Throws if the server refuses.
  explicit ViewClient(std::uint16_t port, const ClientHeaders& headers = {});

  void send(const nlohmann::json& message) { send_text(message.dump()); }
  void send_text(const std::string& text);
  /// Sends a view of a 64 x 48 picture; `more` replaces members of the message.
  void show(std::int64_t id, bool moving, const nlohmann::json& more = {});
  void taken(const ReceivedFrame& frame) { send({{"type", "shown"}, {"frame", frame.header["frame"]}}); }
  /// Returns the next picture; texts before it go to `texts`. nullopt if none comes within `wait`.
  std::optional<ReceivedFrame> frame(std::chrono::milliseconds wait = std::chrono::seconds(20));
  /// Returns the next text of `type`; other texts and pictures are thrown away.
  std::optional<nlohmann::json> text(const std::string& type,
                                     std::chrono::milliseconds wait = std::chrono::seconds(20));
  /// Takes pictures until one of `view` has `samples` per pixel, and returns that picture.
  std::optional<ReceivedFrame> refined(std::int64_t view, int samples);
  /// Returns whether the server ends the connection within `wait`.
  bool ended(std::chrono::milliseconds wait = std::chrono::seconds(10));
  /// Returns the raw connection below the protocol.
  boost::asio::ip::tcp::socket& raw() { return stream_.next_layer(); }

  std::vector<nlohmann::json> texts;

 private:
  struct Message {
    bool binary = false;
    std::string bytes;
  };
  std::optional<Message> read(std::chrono::milliseconds wait);

  boost::asio::io_context io_;
  boost::beast::websocket::stream<boost::asio::ip::tcp::socket> stream_{io_};
  bool broken_ = false;
};

/// Returns the server's answer to a request for a WebSocket: "101", or the status and body of its refusal.
std::string upgrade_answer(std::uint16_t port, const ClientHeaders& headers);

/// Returns status and body of GET `target`, over a separate connection.
std::pair<int, std::string> get(std::uint16_t port, const std::string& target, const ClientHeaders& headers = {},
                                const std::string& authorization = "");

}  // namespace weir
