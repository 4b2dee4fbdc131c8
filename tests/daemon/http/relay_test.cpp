#include "daemon/http/relay.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/local/connect_pair.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>

namespace weir::relay_test {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;
using std::chrono::milliseconds;

/// A relay between `client_`, the page's end, and `server_`.
class RelayTest : public testing::Test {
 protected:
  /// `accepted` is called when the relay has connected to the server.
  void relay(milliseconds taking, const std::function<void()>& accepted) {
    asio::local::stream_protocol::socket theirs(io_);
    asio::local::connect_pair(client_, theirs);
    acceptor_.async_accept(server_, [accepted](const error_code& error) {
      ASSERT_FALSE(error) << error.message();
      accepted();
    });
    const auto made = std::make_shared<Relay>(
        std::move(theirs), "request", [this](Relay&) { ended_ = true; }, taking);
    made->start(acceptor_.local_endpoint(), std::nullopt);
  }

  asio::io_context io_;
  asio::ip::tcp::acceptor acceptor_{io_, {asio::ip::address_v4::loopback(), 0}};
  asio::ip::tcp::socket server_{io_};
  asio::local::stream_protocol::socket client_{io_};
  bool ended_ = false;
};

// Returns the descriptor flags of this process's socket that is connected to `port`; -1 if there is none.
int descriptor_flags_of_connection_to(std::uint16_t port) {
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    const int descriptor = std::stoi(entry.path().filename());
    sockaddr_in peer{};
    socklen_t bytes = sizeof peer;
    if (::getpeername(descriptor, reinterpret_cast<sockaddr*>(&peer), &bytes) == 0 && peer.sin_family == AF_INET &&
        ntohs(peer.sin_port) == port) {
      return ::fcntl(descriptor, F_GETFD);
    }
  }
  return -1;
}

TEST_F(RelayTest, ConnectionToTheServer_IsClosedOnExec) {
  int flags = 0;
  relay(milliseconds(1000), [&] {
    flags = descriptor_flags_of_connection_to(acceptor_.local_endpoint().port());
    server_.close();
    client_.close();
  });
  io_.run_for(std::chrono::seconds(10));
  EXPECT_EQ(flags, FD_CLOEXEC);
}

TEST_F(RelayTest, ClientThatTakesNothing_IsLeft) {
  const std::string picture(64 << 20, 'p');  // more than the buffers of both connections hold
  error_code written;
  relay(milliseconds(100), [&] {
    asio::async_write(server_, asio::buffer(picture), [&](const error_code& error, std::size_t) { written = error; });
  });
  io_.run_for(std::chrono::seconds(10));
  EXPECT_TRUE(ended_);
  EXPECT_TRUE(written) << "the server's connection is closed, too";
}

// The handlers of the finished write and of its timer are both queued at the same time.
TEST_F(RelayTest, ClientThatTakesAPieceAtTheLastMoment_IsKept) {
  const std::string picture(4 << 20, 'p');
  std::string told;
  asio::steady_timer pause(io_);
  relay(milliseconds(500), [&] {
    asio::async_write(server_, asio::buffer(picture),
                      [&](const error_code&, std::size_t) { server_.shutdown(asio::socket_base::shutdown_send); });
    pause.expires_after(milliseconds(200));
    pause.async_wait([&](const error_code&) {
      told.resize(client_.available());
      asio::read(client_, asio::buffer(told));
      std::this_thread::sleep_for(milliseconds(600));
      asio::async_read(client_, asio::dynamic_buffer(told), [&](const error_code&, std::size_t) { client_.close(); });
    });
  });
  io_.run_for(std::chrono::seconds(10));
  EXPECT_EQ(told.size(), picture.size());
  EXPECT_TRUE(ended_);
}

TEST_F(RelayTest, ServerThatSaysNothingForLong_KeepsItsClient) {
  std::string told;
  asio::steady_timer pause(io_);
  relay(milliseconds(1000), [&] {
    asio::write(server_, asio::buffer("a", 1));
    pause.expires_after(milliseconds(1500));
    pause.async_wait([&](const error_code&) {
      asio::write(server_, asio::buffer("b", 1));
      server_.shutdown(asio::socket_base::shutdown_send);
    });
  });
  asio::async_read(client_, asio::dynamic_buffer(told), [&](const error_code& error, std::size_t) {
    EXPECT_EQ(error, asio::error::eof);
    client_.close();
  });
  io_.run_for(std::chrono::seconds(10));
  EXPECT_EQ(told, "ab");
  EXPECT_TRUE(ended_);
}

}  // namespace
}  // namespace weir::relay_test
