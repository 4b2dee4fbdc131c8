#include "daemon/http/view_requests.h"

#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>

#include "daemon/http/page_response.h"
#include "daemon/http/request_target.h"
#include "daemon/http/socket_token.h"
#include "format/base/json_text.h"
#include "format/base/text.h"

namespace weir {
namespace {

namespace http = boost::beast::http;

constexpr std::string_view kPlace = "/view/";

bool is_page_file(const HttpRequest& request) {
  const auto target = parse_target(request.target);
  if (!target || request.upgrade) return false;
  const auto& path = target->path;  // "view", then an empty segment for the page itself
  return (path.size() == 2 && path[1].empty()) || (path.size() == 3 && path[1] == "page");
}

std::optional<HttpResponse> refuse_access(const AccessRules& rules, const HttpRequest& request, bool open) {
  if (auto refused = request.upgrade ? refuse_socket(rules, with_offered_token(request)) : refuse(rules, request, open))
    return refused;
  if (!rules.control_at.empty()) {
    return error_response(403, cat("this address only shows; viewers are at ", rules.control_at));
  }
  if (request.method != "GET" && request.method != "HEAD") {
    HttpResponse response = error_response(405, cat(request.method, " is not for ", request.target, "; use GET, HEAD"));
    response.headers.emplace_back("Allow", "GET, HEAD");
    return response;
  }
  return std::nullopt;
}

std::string why_none(const ViewerView& viewer) {
  if (viewer.state == ViewerState::starting) return "the viewer is being started; ask again in a moment";
  const std::string why = viewer.reason.empty() ? "no viewer runs now" : viewer.reason;
  return viewer.state == ViewerState::off ? why : cat(why, "; open it again with View on the service's page");
}

// The answer for a viewer's page, which waits while the viewer is being started.
HttpResponse answer_without_viewer(const ViewerView& viewer) {
  const nlohmann::json body{{"error", why_none(viewer)},
                            {"state", kViewerStateNames.at(static_cast<std::size_t>(viewer.state))}};
  return {503, "application/json", json_text(body) + "\n", {}};
}

// The answer for a person who opens the address by hand or after the viewer has ended. While a viewer is being
// started, a script reloads the page. It keeps the part behind #; a refresh in the page's head would only jump within
// the page.
HttpResponse page_without_viewer(const ViewerView& viewer) {
  std::string text;
  for (const char c : why_none(viewer)) text += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
  return {503,
          "text/html; charset=utf-8",
          cat("<!doctype html>\n<html lang=\"en\">\n",
              viewer.state == ViewerState::starting ? "<script src=\"../page/again.js\"></script>\n" : "",
              "<title>weir</title>\n<p>", text, ".</p>\n<p><a href=\"../\">The service's page</a></p>\n</html>\n"),
          {}};
}

std::optional<HttpResponse> refuse_now(const AccessRules& rules, const HttpRequest& request, const ViewerView& viewer) {
  const bool file = is_page_file(request);
  if (auto refused = refuse_access(rules, request, file)) return refused;
  if (viewer.state != ViewerState::ready) {
    if (!file) return answer_without_viewer(viewer);
    ViewerView told = viewer;
    if (refuse(rules, request, false))
      told.reason.clear();  // the reason names files, which only holders of the token may see
    return page_without_viewer(told);
  }
  if (request.upgrade && viewer.sockets >= kMostViewerSockets) {
    return error_response(503, cat("the viewer has ", viewer.sockets, " pages open, as many as it may; close one"));
  }
  return std::nullopt;
}

}  // namespace

bool is_view_request(const HttpRequest& request) { return request.target.starts_with(kPlace); }

std::optional<HttpResponse> refuse_view(const AccessRules& rules, const HttpRequest& request,
                                        const ViewerView& viewer) {
  auto refused = refuse_now(rules, request, viewer);
  if (refused) add_page_headers(*refused);
  return refused;
}

std::string forwarded_request(const UpgradeRequest& request, const std::string& token) {
  const std::string_view target(request.target().data(), request.target().size());
  http::request<http::empty_body> sent(request.method(), std::string(target.substr(kPlace.size() - 1)), 11);
  sent.set(http::field::authorization, cat("Bearer ", token));
  const auto keep = [&](http::field field) {
    if (request.count(field) > 0) sent.set(field, request[field]);
  };
  keep(http::field::host);
  keep(http::field::origin);
  if (!boost::beast::websocket::is_upgrade(request)) {
    sent.set(http::field::connection, "close");
  } else {
    sent.set(http::field::connection, "Upgrade");
    for (const http::field field : {http::field::upgrade, http::field::sec_websocket_key,
                                    http::field::sec_websocket_version, http::field::sec_websocket_extensions}) {
      keep(field);
    }
    const auto offered = request[http::field::sec_websocket_protocol];
    const std::string protocols = without_offered_token({offered.data(), offered.size()});
    if (!protocols.empty()) sent.set(http::field::sec_websocket_protocol, protocols);
  }
  std::ostringstream text;
  text << sent;
  return text.str();
}

}  // namespace weir
