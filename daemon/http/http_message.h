// One HTTP request and its answer as plain data, so that what is answered
// (api.h, access.h) knows neither sockets nor the library that reads them.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace weir {

struct HttpRequest {
  std::string method = "GET";
  std::string target;         ///< "/path?query" as sent
  std::string host;           ///< header Host; empty where an HTTP/1.0 client sent none
  std::string authorization;  ///< header Authorization
  std::string content_type;   ///< header Content-Type
  bool marked = false;        ///< a header X-Weir is there, which no foreign web page can send
  std::string origin{};       ///< header Origin: the web page that asks; empty where none says so
  std::string protocols{};    ///< header Sec-WebSocket-Protocol
  bool upgrade = false;       ///< it asks for a WebSocket
};

struct HttpResponse {
  unsigned status = 200;
  std::string content_type = "application/json";
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers;  ///< beyond those that every response has
};

/// {"error": message} with that status; `message` in UTF-8 or not.
HttpResponse error_response(unsigned status, const std::string& message);

/// Answers a request; called on the io_context's thread, must not block. What it throws becomes a 500, but a
/// CorruptDatabase goes through.
using HttpHandler = std::function<HttpResponse(const HttpRequest&)>;

}  // namespace weir
