#include "daemon/config/listen_address.h"

#include <gtest/gtest.h>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir::listen_address_test {
namespace {

TEST(ListenAddress, ReadsHostAndPort) {
  for (const char* text : {"127.0.0.1:8470", "[::1]:0", "localhost:65535", "node-7.cluster:1", "0.0.0.0:80"}) {
    EXPECT_EQ(parse_listen_address(text).text(), text);
  }
  EXPECT_EQ(parse_listen_address("[fe80::1]:8470").host, "fe80::1");
  EXPECT_EQ(parse_listen_address("[fe80::1]:8470").port, 8470);
}

TEST(ListenAddress, ReadsTheSocketsPath) {
  const ListenAddress address = parse_listen_address("unix:/run/weir:1.sock");
  EXPECT_TRUE(address.is_unix());
  EXPECT_EQ(address.path, "/run/weir:1.sock");
  EXPECT_EQ(address.text(), "unix:/run/weir:1.sock");
}

TEST(ListenAddress, RefusesMalformedAddresses) {
  for (const char* text :
       {"", ":", "8470", ":8470", "127.0.0.1", "127.0.0.1:", "127.0.0.1:65536", "127.0.0.1:-1", "127.0.0.1:http",
        "::1:8470", "[127.0.0.1]:1", "[]:1", "[::1:1", "http://localhost:1", "a b:1"}) {
    try {
      parse_listen_address(text);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
      EXPECT_EQ(error.what(), cat('"', text, "\" is no address; write HOST:PORT, as 127.0.0.1:8470 or [::1]:8470"));
    }
  }
}

TEST(ListenAddress, OfAnOption_IsRefusedWithItsName) {
  const auto refusal = [](const std::string& text) {
    try {
      parse_listen_address(text, "--address");
      return std::string();
    } catch (const Error& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(refusal("foo"), "--address: \"foo\" is no address; write HOST:PORT, as 127.0.0.1:8470 or [::1]:8470");
  const std::string longest = "unix:/" + std::string(103, 'x');
  EXPECT_EQ(refusal(longest), cat("--address: ", longest, ": a socket's path has 103 bytes at most"));
}

TEST(ListenAddress, RecognisesLoopbackHosts) {
  for (const char* host : {"localhost", "127.0.0.1", "127.255.255.255", "::1", "0:0:0:0:0:0:0:1"}) {
    EXPECT_TRUE(is_loopback(host)) << host;
  }
  for (const char* host : {"", "0.0.0.0", "::", "10.0.0.1", "128.0.0.1", "localhost.example.org", "node", "127.1"}) {
    EXPECT_FALSE(is_loopback(host)) << host;
  }
}

}  // namespace
}  // namespace weir::listen_address_test
