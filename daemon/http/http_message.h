// One HTTP request and its response as plain data, so that the code of the answers (api.h, access.h) depends neither
// on sockets nor on the HTTP library.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace weir {

struct HttpRequest {
  std::string method = "GET";
  std::string target;         ///< "/path?query" as sent
  std::string host;           ///< header Host; empty if an HTTP/1.0 client sent none
  std::string authorization;  ///< header Authorization
  std::string content_type;   ///< header Content-Type
  bool marked = false;        ///< whether there is an X-Weir header, which no foreign web page can send
  std::string origin{};       ///< header Origin: the web page that sends the request; empty if absent
  std::string protocols{};    ///< header Sec-WebSocket-Protocol
  bool upgrade = false;       ///< the request asks for a WebSocket
};

struct HttpResponse {
  unsigned status = 200;
  std::string content_type = "application/json";
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers;  ///< in addition to the headers that every response has
};

/// Returns a response {"error": message} with this status. `message` may be invalid UTF-8.
HttpResponse error_response(unsigned status, const std::string& message);

/// Answers a request. It is called on the io_context's thread and must not block. An exception becomes a 500, but
/// CorruptDatabase passes through.
using HttpHandler = std::function<HttpResponse(const HttpRequest&)>;

}  // namespace weir
