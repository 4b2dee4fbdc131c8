// Tests the manager of the viewer, with scripts in place of weir.
#include "daemon/viewer/job_viewer.h"

#include <gtest/gtest.h>

#include <boost/asio/local/connect_pair.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <filesystem>

#include "daemon/http/view_requests.h"
#include "format/base/text.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir::job_viewer_test {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using std::chrono::milliseconds;
using Opened = JobViewer::Opened;

ServiceConfig service(std::uint64_t viewer_memory = std::uint64_t{256} << 20) {
  ServiceConfig config;
  config.log_level = "off";
  config.viewer_memory = viewer_memory;
  config.threads = 3;
  return config;
}

class JobViewerTest : public testing::Test {
 protected:
  /// Writes a program that runs `then` in a shell and appends its arguments as a line to `calls`.
  void program(const std::string& then) {
    write_file(program_, cat("#!/bin/sh\necho \"$@\" >> ", directory_ / "calls", "\n", then, "\n"));
    std::filesystem::permissions(program_, std::filesystem::perms(0755));
  }
  /// Writes a program that announces the test's own port.
  void answering_program() {
    program(cat("echo '{\"address\": \"127.0.0.1:", acceptor_.local_endpoint().port(),
                "\", \"token\": \"to\"}' >&3\nexec sleep 60"));
  }
  std::vector<std::string> calls() const {
    std::vector<std::string> lines = split(read_file(directory_ / "calls"), '\n');
    lines.pop_back();
    return lines;
  }
  bool eventually(const std::function<bool()>& holds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!holds() && std::chrono::steady_clock::now() < end) {
      io_.restart();
      io_.run_for(milliseconds(5));
    }
    return holds();
  }
  bool comes_to(JobViewer& viewer, ViewerState state) {
    return eventually([&] { return viewer.view().state == state; });
  }
  /// Returns a client's end of a connection that the viewer answers.
  asio::local::stream_protocol::socket connect(JobViewer& viewer, bool socket) {
    asio::local::stream_protocol::socket ours(io_);
    asio::local::stream_protocol::socket theirs(io_);
    asio::local::connect_pair(ours, theirs);
    UpgradeRequest request(http::verb::get, "/view/ws", 11);
    request.set(http::field::host, "localhost:8470");
    request.set(http::field::authorization, "Bearer the service's");
    if (socket) {
      request.set(http::field::connection, "Upgrade");
      request.set(http::field::upgrade, "websocket");
      request.set(http::field::sec_websocket_key, "a2V5");
      request.set(http::field::sec_websocket_version, "13");
      request.set(http::field::sec_websocket_protocol, "weir.view, weir.token.7365");
    }
    viewer.relay(std::move(theirs), request);
    return ours;
  }

  TemporaryDirectory directory_;
  std::string program_ = directory_ / "program";
  asio::io_context io_;
  asio::ip::tcp::acceptor acceptor_{io_, {asio::ip::address_v4::loopback(), 0}};
  EventLog log_{service()};
};

TEST_F(JobViewerTest, OneViewer_ServesItsWholeSeries) {
  answering_program();
  JobViewer viewer(io_, log_, program_, {.open = milliseconds(0)});
  viewer.configure(service());
  EXPECT_EQ(viewer.view().state, ViewerState::none);
  EXPECT_EQ(viewer.open("/out/s_1.nvdb", false), Opened::made);
  EXPECT_EQ(viewer.view().state, ViewerState::starting);
  EXPECT_EQ(viewer.view().file, "/out/s_1.nvdb");
  ASSERT_TRUE(comes_to(viewer, ViewerState::ready)) << viewer.view().reason;
  EXPECT_GT(viewer.view().rss_bytes, 0U);
  EXPECT_EQ(viewer.open("/out/s_2.nvdb", false), Opened::made);
  EXPECT_EQ(viewer.view().state, ViewerState::ready);
  EXPECT_EQ(calls(), std::vector<std::string>{
                         "view /out/s_1.nvdb --series --private --progress-fd=3 --progress=never --backend=cpu "
                         "--memory=92274688 --forecast-memory=67108864 --pixels=781988 --viewers=4 --threads=3"});
  EXPECT_EQ(viewer.open("/out/t_1.nvdb", false), Opened::made) << "nobody looks at the other one";
  EXPECT_EQ(viewer.view().state, ViewerState::starting);
  ASSERT_TRUE(comes_to(viewer, ViewerState::ready));
  EXPECT_EQ(calls().size(), 2U);
}

TEST_F(JobViewerTest, SeriesThatIsBeingOpened_IsLeftUnlessForced) {
  answering_program();
  JobViewer viewer(io_, log_, program_, {.open = milliseconds(200)});
  viewer.configure(service());
  viewer.open("/out/s_1.nvdb", false);
  EXPECT_EQ(viewer.open("/out/t_1.nvdb", false), Opened::taken) << "it is being started for somebody";
  ASSERT_TRUE(comes_to(viewer, ViewerState::ready));
  EXPECT_EQ(viewer.open("/out/t_1.nvdb", false), Opened::taken) << "the page of who asked is on its way";
  EXPECT_TRUE(eventually([&] { return viewer.open("/out/t_1.nvdb", false) == Opened::made; })) << "it never came";
  EXPECT_EQ(viewer.view().file, "/out/t_1.nvdb");
  EXPECT_EQ(viewer.open("/out/s_1.nvdb", true), Opened::made);
  ASSERT_TRUE(comes_to(viewer, ViewerState::ready));
  {
    auto socket = connect(viewer, true);
    asio::ip::tcp::socket server(io_);
    acceptor_.accept(server);
  }
  EXPECT_TRUE(eventually([&] { return viewer.view().connections == 0; }));
  EXPECT_EQ(viewer.open("/out/t_1.nvdb", false), Opened::made) << "it came, and was closed";
}

TEST_F(JobViewerTest, SeriesThatIsLookedAt_IsLeftUnlessForced) {
  answering_program();
  JobViewer viewer(io_, log_, program_, {.open = milliseconds(0)});
  viewer.configure(service());
  viewer.open("/out/s_1.nvdb", false);
  ASSERT_TRUE(comes_to(viewer, ViewerState::ready));
  auto page = connect(viewer, false);
  EXPECT_EQ(viewer.view().connections, 1U);
  EXPECT_EQ(viewer.open("/out/t_1.nvdb", false), Opened::made) << "a file of the page is no look";
  ASSERT_TRUE(comes_to(viewer, ViewerState::ready));
  auto socket = connect(viewer, true);
  EXPECT_EQ(viewer.open("/out/s_1.nvdb", false), Opened::taken);
  EXPECT_EQ(viewer.view().file, "/out/t_1.nvdb");
  EXPECT_EQ(viewer.open("/out/s_1.nvdb", true), Opened::made);
  EXPECT_EQ(viewer.view().connections, 0U);
  boost::system::error_code error;
  std::array<char, 1> byte{};
  socket.read_some(asio::buffer(byte), error);
  EXPECT_EQ(error, asio::error::eof) << "who looked is told by the end of the connection";
}

TEST_F(JobViewerTest, FilesThatAreNotTaken_KeepNobodyFromLooking) {
  answering_program();
  JobViewer viewer(io_, log_, program_);
  viewer.configure(service());
  viewer.open("/out/s_1.nvdb", false);
  ASSERT_TRUE(comes_to(viewer, ViewerState::ready));
  auto looking = connect(viewer, true);
  std::vector<asio::local::stream_protocol::socket> files;
  for (std::size_t i = 0; i < kMostViewerFiles; ++i) files.push_back(connect(viewer, false));
  EXPECT_EQ(viewer.view().connections, kMostViewerFiles + 1);
  auto another = connect(viewer, false);
  EXPECT_EQ(viewer.view().connections, kMostViewerFiles + 1) << "the oldest file has made room";
  EXPECT_EQ(viewer.view().sockets, 1U);
  boost::system::error_code error;
  std::array<char, 1> byte{};
  files.front().read_some(asio::buffer(byte), error);
  EXPECT_EQ(error, asio::error::eof);
  for (auto* open : {&looking, &files[1], &another}) {
    open->non_blocking(true);
    open->read_some(asio::buffer(byte), error);
    EXPECT_EQ(error, asio::error::would_block);
  }
}

TEST_F(JobViewerTest, Connection_CarriesBytesBothWays) {
  answering_program();
  JobViewer viewer(io_, log_, program_);
  viewer.configure(service());
  viewer.open("/out/s_1.nvdb", false);
  ASSERT_TRUE(comes_to(viewer, ViewerState::ready));
  auto client = connect(viewer, true);
  asio::ip::tcp::socket server(io_);
  bool accepted = false;
  acceptor_.async_accept(server, [&](const boost::system::error_code&) { accepted = true; });
  ASSERT_TRUE(eventually([&] { return accepted && server.available() > 0; }));
  std::string request;
  asio::read_until(server, asio::dynamic_buffer(request), "\r\n\r\n");
  EXPECT_EQ(request,
            "GET /ws HTTP/1.1\r\nAuthorization: Bearer to\r\nHost: localhost:8470\r\nConnection: Upgrade\r\n"
            "Upgrade: websocket\r\nSec-WebSocket-Key: a2V5\r\nSec-WebSocket-Version: 13\r\n"
            "Sec-WebSocket-Protocol: weir.view\r\n\r\n");
  const std::string large(1 << 20, 'p');  // many pieces
  std::string answer;
  asio::async_write(server, asio::buffer(large), [](const boost::system::error_code&, std::size_t) {});
  client.non_blocking(true);
  EXPECT_TRUE(eventually([&] {
    std::array<char, 65536> piece{};
    boost::system::error_code error;
    const std::size_t bytes = client.read_some(asio::buffer(piece), error);
    answer.append(piece.data(), bytes);
    return answer.size() == large.size();
  }));
  EXPECT_EQ(answer, large);
  asio::write(client, asio::buffer(std::string("shown")));
  ASSERT_TRUE(eventually([&] { return server.available() == 5; }));
  client.close();
  server.close();
  EXPECT_TRUE(eventually([&] { return viewer.view().connections == 0; }));
}

TEST_F(JobViewerTest, ViewerThatIsGoneMeanwhile_IsSaidToTheClient) {
  answering_program();
  JobViewer viewer(io_, log_, program_);
  viewer.configure(service());
  viewer.open("/out/s_1.nvdb", false);
  ASSERT_TRUE(comes_to(viewer, ViewerState::ready));
  acceptor_.close();
  auto client = connect(viewer, false);
  ASSERT_TRUE(eventually([&] { return viewer.view().connections == 0; }));
  std::string answer;
  boost::system::error_code error;
  asio::read(client, asio::dynamic_buffer(answer), error);
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 502 Bad Gateway\r\n")) << answer;
  EXPECT_TRUE(
      answer.ends_with("\r\n\r\n{\"error\":\"the viewer does not answer; open it again from the service's "
                       "page\"}\n"))
      << answer;
}

TEST_F(JobViewerTest, NobodyConnected_EndsIt) {
  answering_program();
  JobViewer viewer(io_, log_, program_, {.idle = milliseconds(60)});
  viewer.configure(service());
  viewer.open("/out/s_1.nvdb", false);
  ASSERT_TRUE(comes_to(viewer, ViewerState::ready));
  {
    auto socket = connect(viewer, true);
    eventually([end = std::chrono::steady_clock::now() + milliseconds(150)] {
      return std::chrono::steady_clock::now() > end;
    });
    EXPECT_EQ(viewer.view().state, ViewerState::ready) << "somebody is connected";
    asio::ip::tcp::socket server(io_);
    acceptor_.accept(server);
  }
  EXPECT_TRUE(comes_to(viewer, ViewerState::none));
  EXPECT_EQ(viewer.view().rss_bytes, 0U);
}

TEST_F(JobViewerTest, FailureToStart_IsSaid_AndTheNextAskTriesAgain) {
  JobViewer viewer(io_, log_, program_, {.start = milliseconds(1000)});
  viewer.configure(service());
  EXPECT_EQ(viewer.open("/out/s_1.nvdb", false), Opened::made);
  EXPECT_EQ(viewer.view().state, ViewerState::failed);
  EXPECT_EQ(viewer.view().reason, cat(program_, ": cannot start it: No such file or directory"));
  program("echo 'weir: /out/s_1.nvdb: open: No such file or directory' >&2; exit 3");
  viewer.open("/out/s_1.nvdb", false);
  ASSERT_TRUE(comes_to(viewer, ViewerState::failed));
  EXPECT_EQ(viewer.view().reason, "/out/s_1.nvdb: open: No such file or directory");
  program("exec sleep 60");
  viewer.open("/out/s_1.nvdb", false);
  ASSERT_TRUE(comes_to(viewer, ViewerState::failed));
  EXPECT_EQ(viewer.view().reason, "the viewer did not answer within 1 s");
  answering_program();
  viewer.open("/out/s_1.nvdb", false);
  EXPECT_TRUE(comes_to(viewer, ViewerState::ready));
}

TEST_F(JobViewerTest, Crash_IsSaidAndClosesItsConnections) {
  program(cat("echo '{\"address\": \"127.0.0.1:", acceptor_.local_endpoint().port(),
              "\", \"token\": \"to\"}' >&3\nread line < ", directory_ / "fifo", "\nkill -SEGV $$"));
  ASSERT_EQ(run_command({"mkfifo", directory_ / "fifo"}).exit_code, 0);
  JobViewer viewer(io_, log_, program_);
  viewer.configure(service());
  viewer.open("/out/s_1.nvdb", false);
  ASSERT_TRUE(comes_to(viewer, ViewerState::ready));
  auto socket = connect(viewer, true);
  write_file(directory_ / "fifo", "now\n");
  ASSERT_TRUE(comes_to(viewer, ViewerState::failed));
  EXPECT_EQ(viewer.view().reason, "view was ended by signal 11 (Segmentation fault)");
  EXPECT_EQ(viewer.view().connections, 0U);
}

TEST_F(JobViewerTest, MemoryAboveItsCeiling_EndsIt) {
  answering_program();
  JobViewer viewer(io_, log_, program_, {.look = milliseconds(20)});
  viewer.configure(service(4096));
  viewer.open("/out/s_1.nvdb", false);
  ASSERT_TRUE(comes_to(viewer, ViewerState::failed));
  const std::string reason = viewer.view().reason;
  EXPECT_TRUE(reason.starts_with("the viewer took ")) << reason;
  EXPECT_TRUE(reason.ends_with(", more than viewer_memory = 4.0 KiB; raise that, or make the window smaller"))
      << reason;
}

TEST_F(JobViewerTest, ForecastsHaveAShareOfTheMemory) {
  program("exec sleep 60");
  JobViewer viewer(io_, log_, program_);
  const auto shares = [&](std::uint64_t mebibytes) {
    const std::size_t before = std::filesystem::exists(directory_ / "calls") ? calls().size() : 0;
    viewer.configure(service(mebibytes << 20U));
    viewer.open("/out/s_1.nvdb", true);
    EXPECT_TRUE(eventually([&] { return std::filesystem::exists(directory_ / "calls") && calls().size() > before; }));
    const std::string call = calls().back();
    const std::size_t first = call.find("--memory=");
    return call.substr(first, call.find(" --pixels") - first);
  };
  EXPECT_EQ(shares(191), "--memory=91750400 --forecast-memory=0") << "half of 175 MiB";
  EXPECT_EQ(shares(192), "--memory=58720256 --forecast-memory=67108864") << "half of 192 - 64 - 16 MiB";
  EXPECT_EQ(shares(512), "--memory=192937984 --forecast-memory=134217728");
}

TEST_F(JobViewerTest, ForecastsKeepToBandwidthAndWorkDirectory) {
  program("exec sleep 60");
  JobViewer viewer(io_, log_, program_);
  ServiceConfig config = service();
  config.bandwidth = 1000;
  config.work_dir = "/scratch";
  viewer.configure(config);
  viewer.open("/out/s_1.nvdb", false);
  // The shell creates the file before it writes the line.
  ASSERT_TRUE(eventually([&] { return std::filesystem::exists(directory_ / "calls") && !calls().empty(); }));
  EXPECT_TRUE(calls().back().ends_with(" --threads=3 --forecast-bandwidth=1000 --work-dir=/scratch")) << calls().back();
}

TEST_F(JobViewerTest, NoMemory_IsOff_AndAnotherConfigurationEndsTheOldOne) {
  answering_program();
  JobViewer viewer(io_, log_, program_);
  viewer.configure(service());
  viewer.open("/out/s_1.nvdb", false);
  ASSERT_TRUE(comes_to(viewer, ViewerState::ready));
  viewer.configure(service());
  EXPECT_EQ(viewer.view().state, ViewerState::ready) << "the same";
  viewer.configure(service(0));
  EXPECT_EQ(viewer.view().state, ViewerState::off);
  EXPECT_EQ(viewer.view().reason, "viewers are off: viewer_memory is 0 in the configuration");
  ServiceConfig small = service(0);
  small.memory = std::uint64_t{256} << 20U;
  small.is_standard_viewer = true;
  viewer.configure(small);
  EXPECT_EQ(viewer.view().reason,
            "no viewer: memory is 256.0 MiB, and below 1.0 GiB there is none by default; set viewer_memory = "
            "\"128MiB\" or give more memory");
  EXPECT_EQ(viewer.open("/out/s_1.nvdb", false), Opened::off);
  viewer.configure(service());
  viewer.end();
  EXPECT_EQ(viewer.open("/out/s_1.nvdb", false), Opened::off);
  EXPECT_EQ(viewer.view().reason, "the service is stopping");
  EXPECT_EQ(calls().size(), 1U);
}

}  // namespace
}  // namespace weir::job_viewer_test
