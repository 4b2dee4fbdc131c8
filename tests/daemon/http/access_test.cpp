#include "daemon/http/access.h"

#include <gtest/gtest.h>

namespace weir::access_test {
namespace {

unsigned status_of(const std::optional<HttpResponse>& refusal) { return refusal ? refusal->status : 0; }

HttpRequest request_for(const std::string& host) {
  HttpRequest request;
  request.host = host;
  return request;
}

TEST(Access, ComparesSecrets) {
  EXPECT_TRUE(same_secret("", ""));
  EXPECT_TRUE(same_secret("secret", "secret"));
  EXPECT_FALSE(same_secret("secret", "secreT"));
  EXPECT_FALSE(same_secret("secret", "secre"));
  EXPECT_FALSE(same_secret("secret", "secretsecret"));  // the secret repeats
  EXPECT_FALSE(same_secret("secret", ""));
  EXPECT_FALSE(same_secret("", "secret"));
  EXPECT_FALSE(same_secret("", std::string(1, '\0')));
}

TEST(Access, OnLoopback_RefusesHostsOfOtherMachines) {
  const AccessRules rules;
  for (const char* host :
       {"localhost", "LocalHost:8470", "127.0.0.1", "127.0.0.1:80", "127.8.9.1:1", "[::1]", "[::1]:8470"}) {
    EXPECT_EQ(status_of(refuse(rules, request_for(host), false)), 0U) << host;
  }
  for (const char* host : {"example.org", "localhost.example.org", "127.0.0.1.example.org:8470", "10.0.0.1",
                           "[::2]:8470", "[::1", "localhost@example.org", "0.0.0.0", "2130706433", ":8470"}) {
    EXPECT_EQ(status_of(refuse(rules, request_for(host), true)), 421U) << host;
  }
  EXPECT_EQ(refuse(rules, request_for("example.org"), true)->body,
            "{\"error\":\"Host example.org is not this machine; ask for localhost or 127.0.0.1\"}\n");
}

TEST(Access, BeyondLoopback_AcceptsAnyHost) {
  EXPECT_EQ(status_of(refuse({"secret", false}, request_for("example.org"), true)), 0U);
}

TEST(Access, RefusesRequestsWithoutTheToken) {
  const AccessRules rules{"secret", false};
  HttpRequest request;
  EXPECT_EQ(status_of(refuse(rules, request, false)), 401U);
  EXPECT_EQ(status_of(refuse(rules, request, true)), 0U);
  for (const char* given :
       {"secret", "Bearer", "Bearer ", "Bearer Secret", "Bearer secret ", "Basic secret", "Bearersecret"}) {
    request.authorization = given;
    EXPECT_EQ(status_of(refuse(rules, request, false)), 401U) << given;
  }
  for (const char* given : {"Bearer secret", "bearer secret", "BEARER secret"}) {
    request.authorization = given;
    EXPECT_EQ(status_of(refuse(rules, request, false)), 0U) << given;
  }
}

TEST(Access, SaysHowToAuthenticate) {
  const auto refusal = refuse({"secret", true}, HttpRequest(), false);
  ASSERT_TRUE(refusal);
  ASSERT_EQ(refusal->headers.size(), 1U);
  EXPECT_EQ(refusal->headers[0].first, "WWW-Authenticate");
  EXPECT_EQ(refusal->headers[0].second, "Bearer");
}

TEST(Access, TellsAWrongTokenFromNone) {
  HttpRequest request;
  EXPECT_EQ(refuse({"secret", true}, request, false)->body,
            "{\"error\":\"this needs the service's token: Authorization: Bearer TOKEN\"}\n");
  request.authorization = "Bearer other";
  const auto wrong = refuse({"secret", true}, request, false);
  ASSERT_TRUE(wrong);
  EXPECT_EQ(wrong->status, 401U);
  EXPECT_EQ(wrong->body,
            "{\"error\":\"the token is not the service's; take the one that its configuration names (token, "
            "token_file)\"}\n");
  EXPECT_EQ(wrong->headers.at(0).second, "Bearer error=\"invalid_token\"");
}

TEST(Access, RefusesAPostWithoutJsonTypeOrWeirHeader) {
  HttpRequest request;
  request.method = "POST";
  for (const char* type : {"", "text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x",
                           "text/plain; application/json", "application/jsonp"}) {
    request.content_type = type;
    EXPECT_EQ(status_of(refuse({}, request, false)), 403U) << type;
  }
  for (const char* type : {"application/json", "Application/JSON; charset=utf-8", "application/json ;x"}) {
    request.content_type = type;
    EXPECT_EQ(status_of(refuse({}, request, false)), 0U) << type;
  }
  request.content_type = "text/plain";
  request.marked = true;
  EXPECT_EQ(status_of(refuse({}, request, false)), 0U);
}

TEST(Access, RefusesAPostOutsideTheControlAddress) {
  AccessRules rules;
  rules.control_at = "unix:/run/weir.sock";
  HttpRequest request;
  request.marked = true;
  EXPECT_EQ(status_of(refuse(rules, request, false)), 0U);
  request.method = "POST";
  const auto refusal = refuse(rules, request, false);
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->status, 403U);
  EXPECT_NE(refusal->body.find("this address only shows; ask at unix:/run/weir.sock (--address, --config)"),
            std::string::npos)
      << refusal->body;
}

TEST(Access, RefusesSocketsOfForeignPages) {
  const AccessRules rules;
  HttpRequest request = request_for("localhost:8470");
  EXPECT_EQ(status_of(refuse_socket(rules, request)), 0U) << "no browser";
  for (const char* origin : {"http://localhost:8470", "https://LOCALHOST:8470"}) {
    request.origin = origin;
    EXPECT_EQ(status_of(refuse_socket(rules, request)), 0U) << origin;
  }
  for (const char* origin : {"http://localhost", "http://localhost:8471", "http://example.org", "null", "file://",
                             "http://localhost:8470.example.org"}) {
    request.origin = origin;
    EXPECT_EQ(status_of(refuse_socket(rules, request)), 403U) << origin;
  }
  request.origin = "http://example.org";
  EXPECT_EQ(refuse_socket(rules, request)->body,
            "{\"error\":\"Origin http://example.org is not localhost:8470; open this server's own page\"}\n");
  request.origin.clear();
  EXPECT_EQ(status_of(refuse_socket({"secret", true}, request)), 401U);
}

}  // namespace
}  // namespace weir::access_test
