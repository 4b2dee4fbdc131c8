#include "daemon/http/relay.h"

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/local/connect_pair.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <functional>
#include <memory>
#include <string>

namespace weir::relay_test {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;
using std::chrono::milliseconds;

/// A relay between `client_`, what a page holds, and `server_`.
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

TEST_F(RelayTest, ClientThatTakesNothing_IsLeft) {
  const std::string picture(64 << 20, 'p');  // more than both connections hold on their way
  error_code written;
  relay(milliseconds(100), [&] {
    asio::async_write(server_, asio::buffer(picture), [&](const error_code& error, std::size_t) { written = error; });
  });
  io_.run_for(std::chrono::seconds(10));
  EXPECT_TRUE(ended_);
  EXPECT_TRUE(written) << "the server's connection is closed, too";
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
