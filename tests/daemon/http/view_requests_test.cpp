#include "daemon/http/view_requests.h"

#include <gtest/gtest.h>

#include "daemon/http/socket_token.h"

namespace weir::view_requests_test {
namespace {

/// Returns the refusal as "STATUS BODY"; empty if there is none.
std::string refusal(const AccessRules& rules, const HttpRequest& request, const ViewerView& viewer) {
  const auto refused = refuse_view(rules, request, viewer);
  return refused ? std::to_string(refused->status) + " " + refused->body : "";
}

HttpRequest ask(const std::string& target, const std::string& authorization = "") {
  HttpRequest request;
  request.target = target;
  request.host = "localhost:8470";
  request.authorization = authorization;
  return request;
}

HttpRequest ask_socket(const std::string& origin, const std::string& protocols) {
  HttpRequest request = ask("/view/ws");
  request.upgrade = true;
  request.origin = origin;
  request.protocols = protocols;
  return request;
}

ViewerView in_state(ViewerState state, const std::string& reason = "") {
  ViewerView viewer;
  viewer.state = state;
  viewer.reason = reason;
  return viewer;
}

const ViewerView kReady = in_state(ViewerState::ready);

TEST(ViewRequests, AreThoseBelowView) {
  EXPECT_TRUE(is_view_request(ask("/view/")));
  EXPECT_TRUE(is_view_request(ask("/view/page/view.js")));
  EXPECT_FALSE(is_view_request(ask("/view")));
  EXPECT_FALSE(is_view_request(ask("/api/jobs/1/view")));
  EXPECT_FALSE(is_view_request(ask("/")));
}

TEST(ViewRequests, TokenIsNeededForAllButThePage) {
  const AccessRules rules{"se", true};
  EXPECT_EQ(refusal(rules, ask("/view/"), kReady), "");
  EXPECT_EQ(refusal(rules, ask("/view/page/view.js"), kReady), "");
  EXPECT_EQ(refusal(rules, ask("/view/api/state"), kReady).substr(0, 3), "401");
  EXPECT_EQ(refusal(rules, ask("/view/page/x/y"), kReady).substr(0, 3), "401");
  EXPECT_EQ(refusal(rules, ask("/view/api/state", "Bearer se"), kReady), "");
  EXPECT_EQ(refusal(rules, ask_socket("", "weir.view"), kReady).substr(0, 3), "401");
  EXPECT_EQ(refusal(rules, ask_socket("", "weir.view, weir.token.7366"), kReady).substr(0, 3), "401");
  EXPECT_EQ(refusal(rules, ask_socket("", "weir.view, weir.token.7365"), kReady), "");
  HttpRequest page = ask("/view/");
  page.upgrade = true;
  EXPECT_EQ(refusal(rules, page, kReady).substr(0, 3), "401") << "a WebSocket is no file of the page";
}

// The reason may name files.
TEST(ViewRequests, WhyAViewerFailedIsForWhoHasTheToken) {
  const AccessRules rules{"se", true};
  const ViewerView failed = in_state(ViewerState::failed, "weir: /runs/secret.nvdb: is damaged");
  EXPECT_EQ(refusal(rules, ask("/view/"), failed).find("secret"), std::string::npos);
  EXPECT_NE(refusal(rules, ask("/view/"), failed).find("no viewer runs now"), std::string::npos);
  EXPECT_NE(refusal(rules, ask("/view/", "Bearer se"), failed).find("/runs/secret.nvdb: is damaged"),
            std::string::npos);
}

TEST(ViewRequests, ForeignPagesAreRefused) {
  const AccessRules rules;
  EXPECT_EQ(refusal(rules, ask_socket("http://evil.example", ""), kReady),
            "403 {\"error\":\"Origin http://evil.example is not localhost:8470; open this server's own page\"}\n");
  EXPECT_EQ(refusal(rules, ask_socket("http://localhost:8470", ""), kReady), "");
  HttpRequest rebound = ask("/view/");
  rebound.host = "evil.example";
  EXPECT_EQ(refusal(rules, rebound, kReady).substr(0, 3), "421");
}

TEST(ViewRequests, ChangeNothing_AndAreNotAnsweredWhereNothingMayBeChanged) {
  HttpRequest post = ask("/view/api/state");
  post.method = "POST";
  post.marked = true;
  EXPECT_EQ(refusal({}, post, kReady), "405 {\"error\":\"POST is not for /view/api/state; use GET, HEAD\"}\n");
  EXPECT_EQ(refusal({"", true, "unix:/run/weir.sock"}, ask("/view/"), kReady),
            "403 {\"error\":\"this address only shows; viewers are at unix:/run/weir.sock\"}\n");
}

TEST(ViewRequests, WithoutAViewer_AreAnsweredWith503) {
  EXPECT_EQ(
      refusal({}, ask("/view/api/state"), in_state(ViewerState::none)),
      "503 {\"error\":\"no viewer runs now; open it again with View on the service's page\",\"state\":\"none\"}\n");
  EXPECT_EQ(refusal({}, ask_socket("", ""), in_state(ViewerState::starting)),
            "503 {\"error\":\"the viewer is being started; ask again in a moment\",\"state\":\"starting\"}\n");
  const std::string starting = refusal({}, ask("/view/"), in_state(ViewerState::starting));
  EXPECT_NE(starting.find("<script src=\"../page/again.js\"></script>\n"), std::string::npos) << starting;
  const std::string page = refusal({}, ask("/view/"), in_state(ViewerState::failed, "<a> & b"));
  EXPECT_NE(page.find("<p>&lt;a> &amp; b; open it again with View on the service's page.</p>"), std::string::npos)
      << page;
  EXPECT_EQ(page.find("script"), std::string::npos) << page;
  ViewerView full = kReady;
  full.sockets = kMostViewerSockets;
  EXPECT_EQ(refusal({}, ask_socket("", ""), full),
            "503 {\"error\":\"the viewer has 16 pages open, as many as it may; close one\"}\n");
  full.sockets = 0;
  full.connections = 1000;
  EXPECT_EQ(refusal({}, ask_socket("", ""), full), "") << "files of the page are counted for themselves";
}

TEST(ViewRequests, ForwardedRequest_HasTheViewersTokenAndNoOtherHeaders) {
  UpgradeRequest request(boost::beast::http::verb::head, "/view/page/view.js?x=1", 11);
  request.set("Host", "node17:8470");
  request.set("Cookie", "a=b");
  request.set("Authorization", "Bearer se");
  request.set("Transfer-Encoding", "chunked");
  request.body() = "body";
  EXPECT_EQ(forwarded_request(request, "to"),
            "HEAD /page/view.js?x=1 HTTP/1.1\r\nAuthorization: Bearer to\r\nHost: node17:8470\r\nConnection: "
            "close\r\n\r\n");
}

TEST(SocketToken, IsTakenFromTheProtocols) {
  HttpRequest request;
  request.protocols = "weir.view, weir.token.7365, other";
  EXPECT_EQ(with_offered_token(request).authorization, "Bearer se");
  EXPECT_EQ(without_offered_token(request.protocols), "weir.view, other");
  request.protocols = "weir.token.7";
  EXPECT_EQ(with_offered_token(request).authorization, "Bearer ");
  EXPECT_EQ(without_offered_token(request.protocols), "");
}

}  // namespace
}  // namespace weir::view_requests_test
