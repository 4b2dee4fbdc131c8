#include "daemon/http/control_server.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <filesystem>
#include <fstream>

#include "format/base/error.h"
#include "format/io/descriptor.h"
#include "tests/daemon/support/fake_control.h"
#include "tests/daemon/support/raw_client.h"
#include "tests/daemon/support/served.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

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

TEST(ControlServer, RefusesToListenOnAHostName) {
  FakeControl control;
  boost::asio::io_context io;
  try {
    const ControlServer server(io, settings({"node", 8470}, "secret"), control);
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "node:8470: cannot listen on a name; write this machine's address, or 0.0.0.0 for all");
  }
}

TEST(ControlServer, ChecksTheTokenOnEveryRequestOfAConnection) {
  FakeControl control;
  Served served(control, "secret");
  RawClient client(served.port());
  const std::string start = "GET /api/status HTTP/1.1\r\nHost: localhost\r\n";
  EXPECT_EQ(client.ask(start + "\r\n").status, 401);
  EXPECT_EQ(client.ask(start + "Authorization: Bearer secret\r\n\r\n").status, 200);
  const RawResponse refused = client.ask(start + "Authorization: Bearer guess\r\n\r\n");
  EXPECT_EQ(refused.status, 401);
  EXPECT_EQ(refused.header("WWW-Authenticate"), "Bearer error=\"invalid_token\"");
  EXPECT_EQ(client.ask("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n").status, 200);
}

TEST(ControlServer, RefusesPostsOfForeignPages) {
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

class ControlSocket : public testing::Test {
 protected:
  static std::string refusal(const ControlServerSettings& settings) {
    FakeControl control;
    boost::asio::io_context io;
    try {
      const ControlServer server(io, settings, control);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
  // Returns a socket of another program that is bound to path_.
  Descriptor bound_socket(int type) const {
    Descriptor made(::socket(AF_UNIX, type, 0));
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path_.copy(address.sun_path, sizeof address.sun_path - 1);
    EXPECT_EQ(::bind(made.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    return made;
  }
  ControlServerSettings with_socket() const {
    ControlServerSettings result = settings({"127.0.0.1", 0}, "");
    result.control_socket = path_;
    return result;
  }

  TemporaryDirectory directory_;
  std::string path_ = directory_ / "weir.sock";
};

TEST_F(ControlSocket, OwnerAndGroupMayConnect) {
  FakeControl control;
  const mode_t before = ::umask(0);
  {
    const Served served(control, "", {}, path_);
    ::umask(before);
    struct stat status {};
    ASSERT_EQ(::lstat(path_.c_str(), &status), 0);
    EXPECT_TRUE(S_ISSOCK(status.st_mode));
    EXPECT_EQ(status.st_mode & 0777U, 0660U);
  }
  EXPECT_FALSE(std::filesystem::exists(path_));
  EXPECT_EQ(list_directory(directory_.path()), std::vector<std::string>{"weir.sock.lock"});
}

TEST_F(ControlSocket, TcpIsReadOnlyAndTheSocketTakesPosts) {
  FakeControl control;
  Served served(control, "secret", {}, path_);
  const std::string post = "POST /api/pause HTTP/1.1\r\nHost: localhost\r\nX-Weir: 1\r\nContent-Length: 0\r\n";
  const std::string get = "GET /api/status HTTP/1.1\r\nHost: localhost\r\n";
  const std::string token = "Authorization: Bearer secret\r\n";
  RawClient tcp(served.port());
  EXPECT_EQ(tcp.ask(post + "\r\n").status, 401);
  const RawResponse refused = tcp.ask(post + token + "\r\n");
  EXPECT_EQ(refused.status, 403);
  EXPECT_NE(refused.body.find("ask at unix:" + path_), std::string::npos) << refused.body;
  const RawResponse shown = tcp.ask(get + token + "\r\n");
  EXPECT_EQ(shown.status, 200);
  EXPECT_NE(shown.body.find("\"control_at\":\"unix:" + path_ + "\""), std::string::npos) << shown.body;
  EXPECT_TRUE(served.run([&] { return control.asked.empty(); }));

  RawClient local(path_);
  const RawResponse here = local.ask(get + "\r\n");
  EXPECT_EQ(here.status, 200);
  EXPECT_NE(here.body.find("\"control_at\":null"), std::string::npos) << here.body;
  EXPECT_EQ(local.ask(post + "\r\n").status, 200);
  EXPECT_EQ(served.run([&] { return control.asked.size(); }), 1U);
  // A foreign page's request through a tunnel's loopback port, with a host name that points there.
  EXPECT_EQ(
      local.ask("POST /api/pause HTTP/1.1\r\nHost: rebound.example\r\nX-Weir: 1\r\nContent-Length: 0\r\n\r\n").status,
      421);
}

TEST_F(ControlSocket, SocketLeftByAKilledServiceIsReplaced) {
  bound_socket(SOCK_STREAM);  // closed at once; its path stays
  FakeControl control;
  const Served served(control, "", {}, path_);
  RawClient local(path_);
  EXPECT_EQ(local.ask("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n").status, 200);
}

TEST_F(ControlSocket, SocketInUseOrForeignFile_IsNotReplaced) {
  {
    FakeControl control;
    const Served served(control, "", {}, path_);
    EXPECT_EQ(refusal(with_socket()), path_ +
                                          ": cannot listen: another process does; is another weir watch running? "
                                          "choose another service.control_socket");
    RawClient local(path_);
    EXPECT_EQ(local.ask("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n").status, 200);
  }
  {  // a program that takes no lock and accepts no stream connections
    const Descriptor other = bound_socket(SOCK_DGRAM);
    EXPECT_EQ(refusal(with_socket()),
              path_ + ": cannot see whether another process listens there: Protocol wrong type for socket");
    std::filesystem::remove(path_);
  }
  std::ofstream(path_) << "result";
  EXPECT_EQ(refusal(with_socket()), path_ + ": cannot listen: there is a file that is no socket; name another path");
  EXPECT_EQ(std::filesystem::file_size(path_), 6U);
  path_ = directory_ / "nowhere/weir.sock";
  EXPECT_EQ(refusal(with_socket()),
            path_ + ": cannot listen: there is no such directory; make it, or choose another service.control_socket");
  path_ = directory_ / std::string(120, 'x');
  EXPECT_EQ(refusal(with_socket()), path_ +
                                        ": cannot listen: a socket's path has 103 bytes at most; choose a shorter "
                                        "service.control_socket");
}

}  // namespace
}  // namespace weir::control_server_test
