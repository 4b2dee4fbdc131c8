#include "daemon/control_server.h"

#include <gtest/gtest.h>

#include "format/error.h"
#include "tests/daemon/fake_control.h"
#include "tests/daemon/raw_client.h"
#include "tests/daemon/served.h"

namespace weir::control_server_test {
namespace {

ControlServerSettings settings(const ListenAddress& address, const std::string& token) {
  ControlServerSettings result;
  result.address = address;
  result.token = token;
  return result;
}

TEST(ControlServer, ListensBeyondThisMachineOnlyWithAToken) {
  FakeControl control;
  boost::asio::io_context io;
  for (const char* host : {"0.0.0.0", "::", "10.1.2.3", "node"}) {
    try {
      const ControlServer server(io, settings({host, 8470}, ""), control);
      ADD_FAILURE() << host;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
      EXPECT_EQ(error.what(), cat(ListenAddress{host, 8470}.text(),
                                  ": can be reached from other machines, so it needs a token; set "
                                  "service.token_file, or listen on 127.0.0.1"));
    }
  }
  const ControlServer server(io, settings({"0.0.0.0", 0}, "secret"), control);
  EXPECT_NE(server.port(), 0);
}

TEST(ControlServer, ListensOnAddressesNotNames) {
  FakeControl control;
  boost::asio::io_context io;
  try {
    const ControlServer server(io, settings({"node", 8470}, "secret"), control);
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "node:8470: cannot listen on a name; write this machine's address, or 0.0.0.0 for all");
  }
}

TEST(ControlServer, WantsTheTokenOnEveryRequestOfAConnection) {
  FakeControl control;
  Served served(control, "secret");
  RawClient client(served.port());
  const std::string start = "GET /api/status HTTP/1.1\r\nHost: localhost\r\n";
  EXPECT_EQ(client.ask(start + "\r\n").status, 401);
  EXPECT_EQ(client.ask(start + "Authorization: Bearer secret\r\n\r\n").status, 200);
  const RawResponse refused = client.ask(start + "Authorization: Bearer guess\r\n\r\n");
  EXPECT_EQ(refused.status, 401);
  EXPECT_EQ(refused.header("WWW-Authenticate"), "Bearer");
  EXPECT_EQ(client.ask("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n").status, 200);
}

TEST(ControlServer, TakesPostsOfItsOwnClientsOnly) {
  FakeControl control;
  Served served(control);
  RawClient client(served.port());
  const std::string start = "POST /api/pause HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\n";
  EXPECT_EQ(client.ask(start + "Origin: http://foreign.example\r\nContent-Type: text/plain\r\n\r\n").status, 403);
  EXPECT_EQ(
      client.ask("POST /api/pause HTTP/1.1\r\nHost: rebound.example\r\nX-Weir: 1\r\nContent-Length: 0\r\n\r\n").status,
      421);
  EXPECT_TRUE(served.run([&] { return control.asked.empty(); }));
  EXPECT_EQ(client.ask(start + "X-Weir: 1\r\n\r\n").status, 200);
  EXPECT_EQ(client.ask(start + "Content-Type: application/json\r\n\r\n").status, 200);
  EXPECT_EQ(served.run([&] { return control.asked.size(); }), 2U);
}

}  // namespace
}  // namespace weir::control_server_test
