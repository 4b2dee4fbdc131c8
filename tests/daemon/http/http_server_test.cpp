// Tests the server from outside, through raw sockets: what clients may do and what they may not.
#include "daemon/http/http_server.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>
#include <vector>

#include "daemon/jobs/process_usage.h"
#include "daemon/store/sqlite.h"
#include "format/base/error.h"
#include "tests/daemon/support/fake_control.h"
#include "tests/daemon/support/raw_client.h"
#include "tests/daemon/support/served.h"
#include "tests/support/sanitized.h"

namespace weir::http_server_test {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr std::string_view kHealth = "GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n";

HttpLimits short_limits() {
  HttpLimits limits;
  limits.request = milliseconds(200);
  limits.idle = milliseconds(400);
  limits.response = milliseconds(300);
  limits.linger = milliseconds(100);
  return limits;
}

TEST(HttpServer, AnswersAndKeepsTheConnection) {
  FakeControl control;
  Served served(control);
  RawClient client(served.port());
  for (int i = 0; i < 3; ++i) {
    const RawResponse response = client.ask(kHealth);
    EXPECT_EQ(response.status, 200);
    EXPECT_EQ(response.body, "ok\n");
    EXPECT_EQ(response.header("Content-Type"), "text/plain; charset=utf-8");
  }
}

TEST(HttpServer, ClosesWhenAskedTo) {
  FakeControl control;
  Served served(control);
  RawClient client(served.port());
  EXPECT_EQ(client.ask("GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n").status, 200);
  EXPECT_TRUE(client.closed_within(milliseconds(2000)));
  RawClient old(served.port());
  EXPECT_EQ(old.ask("GET /healthz HTTP/1.0\r\n\r\n").status, 200);
  EXPECT_TRUE(old.closed_within(milliseconds(2000)));
}

TEST(HttpServer, AnswersPipelinedRequestsInOrder) {
  FakeControl control;
  control.all.resize(1);
  control.all[0].id = 7;
  Served served(control);
  RawClient client(served.port());
  std::string requests;
  for (int i = 0; i < 50; ++i) {
    requests += kHealth;
    requests += "POST /api/jobs/7/retry HTTP/1.1\r\nHost: localhost\r\nX-Weir: 1\r\nContent-Length: 4\r\n\r\nbody";
    requests += "GET /nowhere HTTP/1.1\r\nHost: localhost\r\n\r\n";
  }
  ASSERT_TRUE(client.send(requests));
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(client.receive().status, 200);
    EXPECT_EQ(client.receive().status, 409);
    EXPECT_EQ(client.receive().status, 404);
  }
}

TEST(HttpServer, SendsNoBodyForHead) {
  FakeControl control;
  Served served(control);
  RawClient client(served.port());
  client.send("HEAD /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n");
  const RawResponse response = client.receive(false);
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(response.header("Content-Length"), "3");
  client.send("HEAD /nowhere HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(client.receive(false).status, 404);
  EXPECT_EQ(client.ask(kHealth).body, "ok\n");  // no bytes of the first answer are left over
}

TEST(HttpServer, RefusesMalformedRequests) {
  FakeControl control;
  Served served(control);
  for (const std::string_view nonsense : {
           "\r\n\r\n\r\n",
           "hello\r\n\r\n",
           "GET /healthz\r\n\r\n",
           "GET /healthz HTTP/3.0\r\n\r\n",
           "GET /healthz HTTP/1.1\r\nHost localhost\r\n\r\n",
           "GET /healthz HTTP/1.1\r\n Host: localhost\r\n\r\n",
           "GET  /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n",
           "G\x01T /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n",
           "\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n",  // TLS
           "POST /api/pause HTTP/1.1\r\nHost: localhost\r\nContent-Length: -1\r\n\r\n",
           "POST /api/pause HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1x\r\n\r\n",
           "POST /api/pause HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\nab",
           "POST /api/pause HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n",
           "GET /healthz HTTP/1.1\r\n\r\n",
           "GET /healthz HTTP/1.1\r\nHost: localhost\r\nHost: localhost\r\n\r\n",
       }) {
    RawClient client(served.port());
    EXPECT_EQ(client.ask(nonsense).status, 400) << nonsense;
    EXPECT_TRUE(client.closed_within(milliseconds(2000))) << nonsense;
  }
  EXPECT_TRUE(control.asked.empty());
  RawClient client(served.port());
  EXPECT_EQ(client.ask(kHealth).status, 200);
}

TEST(HttpServer, RefusesALongHeader) {
  FakeControl control;
  Served served(control);
  const auto with_header = [](std::size_t bytes) {
    const std::string start = "GET /healthz HTTP/1.1\r\nHost: localhost\r\nX-Long: ";
    return start + std::string(bytes - start.size() - 4, 'x') + "\r\n\r\n";
  };
  RawClient fits(served.port());
  EXPECT_EQ(fits.ask(with_header(8 << 10)).status, 200);
  for (const std::size_t bytes : {8193U, 16384U, 1U << 20}) {
    RawClient client(served.port());
    const RawResponse response = client.ask(with_header(bytes));
    EXPECT_EQ(response.status, 431) << bytes;
    EXPECT_EQ(response.body, "{\"error\":\"the request's header is too large\"}\n");
  }
  RawClient fields(served.port());
  std::string many = "GET /healthz HTTP/1.1\r\nHost: localhost\r\n";
  for (int i = 0; i < 100'000; ++i) many += "A: b\r\n";
  EXPECT_EQ(fields.ask(many).status, 431);
  RawClient client(served.port());
  EXPECT_EQ(client.ask(cat("GET /", std::string(9000, 'x'), " HTTP/1.1\r\nHost: localhost\r\n\r\n")).status, 431);
}

TEST(HttpServer, RefusesALongBody) {
  FakeControl control;
  Served served(control);
  const auto with_body = [](std::size_t bytes) {
    return cat("POST /api/pause HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: ",
               bytes, "\r\n\r\n", std::string(bytes, ' '));
  };
  RawClient fits(served.port());
  EXPECT_EQ(fits.ask(with_body(64 << 10)).status, 200);
  RawClient client(served.port());
  EXPECT_EQ(client.ask(with_body((64 << 10) + 1)).status, 413);
  EXPECT_TRUE(client.closed_within(milliseconds(2000)));
  std::string chunked =
      "POST /api/pause HTTP/1.1\r\nHost: localhost\r\nX-Weir: 1\r\nTransfer-Encoding: chunked\r\n\r\n";
  for (int i = 0; i < 20; ++i) chunked += "1000\r\n" + std::string(0x1000, 'x') + "\r\n";
  RawClient streaming(served.port());
  EXPECT_EQ(streaming.ask(chunked).status, 413);
  EXPECT_EQ(served.run([&] { return control.asked.size(); }), 1U);
}

TEST(HttpServer, ReadsRequestsSentByteByByte) {
  FakeControl control;
  Served served(control);
  RawClient client(served.port());
  const std::string post =
      "POST /api/pause HTTP/1.1\r\nHost: localhost\r\nX-Weir: 1\r\nTransfer-Encoding: "
      "chunked\r\n\r\n3\r\nabc\r\n0\r\n\r\n";
  for (const char c : post + std::string(kHealth)) {
    ASSERT_TRUE(client.send({&c, 1}));
    std::this_thread::sleep_for(milliseconds(1));
  }
  EXPECT_EQ(client.receive().status, 200);
  EXPECT_EQ(client.receive().body, "ok\n");
}

TEST(HttpServer, RefusesASlowSender) {
  FakeControl control;
  Served served(control, "", short_limits());
  RawClient client(served.port());
  const auto start = Clock::now();
  // Sending one byte at a time does not extend the time limit.
  for (const char c : std::string_view("GET /healthz HTTP/1.1\r\n")) {
    if (!client.send({&c, 1})) break;
    std::this_thread::sleep_for(milliseconds(20));
  }
  const RawResponse response = client.receive();
  EXPECT_EQ(response.status, 408);
  EXPECT_EQ(response.body, "{\"error\":\"the request took too long to arrive\"}\n");
  EXPECT_TRUE(client.closed_within(milliseconds(2000)));
  EXPECT_LT(Clock::now() - start, std::chrono::seconds(3));
}

TEST(HttpServer, RefusesASlowBody) {
  FakeControl control;
  Served served(control, "", short_limits());
  RawClient client(served.port());
  client.send("POST /api/pause HTTP/1.1\r\nHost: localhost\r\nX-Weir: 1\r\nContent-Length: 10\r\n\r\nabc");
  EXPECT_EQ(client.receive().status, 408);
  EXPECT_TRUE(served.run([&] { return control.asked.empty(); }));
}

TEST(HttpServer, ClosesAnIdleConnection) {
  FakeControl control;
  Served served(control, "", short_limits());
  RawClient fresh(served.port());
  RawClient used(served.port());
  EXPECT_EQ(used.ask(kHealth).status, 200);
  EXPECT_TRUE(fresh.closed_within(milliseconds(2000)));
  EXPECT_TRUE(used.closed_within(milliseconds(2000)));
}

TEST(HttpServer, DropsAClientThatDoesNotReadItsAnswers) {
  FakeControl control;
  control.all.resize(1000);
  for (std::size_t i = 0; i < control.all.size(); ++i) control.all[i].source = std::string(4000, 'x');
  Served served(control, "", short_limits());
  RawClient client(served.port());
  // Megabytes of unread answers fill the socket's buffers.
  for (int i = 0; i < 8; ++i) client.send("GET /api/jobs?limit=1000 HTTP/1.1\r\nHost: localhost\r\n\r\n");
  std::this_thread::sleep_for(milliseconds(2500));
  int whole = 0;
  while (client.receive().status == 200) ++whole;
  EXPECT_LT(whole, 8);
  RawClient other(served.port());
  EXPECT_EQ(other.ask(kHealth).status, 200);
}

TEST(HttpServer, ServesBesideManyIdleConnections) {
  FakeControl control;
  Served served(control);
  std::vector<RawClient> idle;
  for (int i = 0; i < 500; ++i) idle.emplace_back(served.port());
  const auto start = Clock::now();
  RawClient client(served.port());
  EXPECT_EQ(client.ask(kHealth).status, 200);
  EXPECT_LT(Clock::now() - start, milliseconds(500));
  EXPECT_EQ(idle.front().ask(kHealth).status, 200);
  EXPECT_EQ(idle.back().ask(kHealth).status, 200);
}

TEST(HttpServer, ClosesTheOldestIdleConnectionForANewOne) {
  FakeControl control;
  HttpLimits limits;
  limits.connections = 4;
  Served served(control, "", limits);
  std::vector<RawClient> clients;
  for (int i = 0; i < 4; ++i) {
    clients.emplace_back(served.port());
    EXPECT_EQ(clients.back().ask(kHealth).status, 200);
  }
  EXPECT_EQ(clients[0].ask(kHealth).status, 200);  // now the second client is idle for the longest time
  RawClient another(served.port());
  EXPECT_EQ(another.ask(kHealth).status, 200);
  EXPECT_TRUE(clients[1].closed_within(milliseconds(2000)));
  for (const std::size_t i : {0U, 2U, 3U}) EXPECT_EQ(clients[i].ask(kHealth).status, 200) << i;
}

TEST(HttpServer, ServesBesideSendersThatNeverFinish) {
  FakeControl control;
  HttpLimits limits;
  limits.connections = 4;
  Served served(control, "", limits);
  std::vector<RawClient> slow;
  for (int i = 0; i < 20; ++i) {
    slow.emplace_back(served.port());
    slow.back().send("GET /healthz HT");
  }
  RawClient client(served.port());
  EXPECT_EQ(client.ask(kHealth).status, 200);
}

// There are more slow senders than connections, and each reconnects as soon as it is closed. So the connection that
// is closed for a new one must be that of a slow sender.
TEST(HttpServer, ServesFreshClientsBesideSlowSendersThatComeBack) {
  FakeControl control;
  HttpLimits limits;
  limits.connections = 64;
  Served served(control, "", limits);
  std::atomic<bool> over = false;
  std::atomic<int> connected = 0;
  std::thread attack([&] {
    std::vector<std::unique_ptr<RawClient>> slow(100);
    while (!over) {
      for (auto& client : slow) {
        if (client != nullptr && !client->closed_within(milliseconds(0))) continue;
        client = std::make_unique<RawClient>(served.port());
        client->send("GET /healthz HT");
        ++connected;
      }
      std::this_thread::sleep_for(milliseconds(20));
    }
  });
  while (connected < 100) std::this_thread::sleep_for(milliseconds(1));
  int asked = 0;
  int answered = 0;
  const auto deadline = Clock::now() + std::chrono::seconds(20);
  while ((asked < 200 || connected < 300) && Clock::now() < deadline) {
    ++asked;
    answered += RawClient(served.port()).ask(kHealth).status == 200 ? 1 : 0;
  }
  over = true;
  attack.join();
  EXPECT_GE(connected, 300) << "nobody was closed";
  EXPECT_GE(answered, asked * 19 / 20);  // a client may be delayed for so long that it is the slowest itself
}

TEST(HttpServer, RefusesCodingsOfTheBodyThatItDoesNotKnow) {
  FakeControl control;
  Served served(control);
  for (const char* coding : {"gzip", "gzip, chunked", "identity"}) {
    RawClient client(served.port());
    const RawResponse response =
        client.ask(cat("POST /api/pause HTTP/1.1\r\nHost: localhost\r\nX-Weir: t\r\nTransfer-Encoding: ", coding,
                       "\r\n\r\n0\r\n\r\n"));
    EXPECT_EQ(response.status, 501) << coding;
    EXPECT_EQ(response.header("Connection"), "close") << coding;
  }
  EXPECT_TRUE(control.asked.empty());
}

TEST(HttpServer, OutlivesAShortageOfDescriptors) {
  if (kSanitized) GTEST_SKIP() << "a sanitizer needs descriptors, too";
  FakeControl control;
  Served served(control);
  std::vector<RawClient> clients(20);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  const rlimit tight{process_usage().open_descriptors + 5, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &tight), 0);
  for (RawClient& client : clients) client.connect(served.port());
  const RawResponse meanwhile = clients.back().ask(kHealth);  // idle connections were closed for it
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
  EXPECT_EQ(meanwhile.status, 200);
  EXPECT_EQ(RawClient(served.port()).ask(kHealth).status, 200);
}

TEST(HttpServer, ErrorWhileAnswering_Is500WithItsMessage) {
  FakeControl control;
  control.before_answer = [] { throw Error(ErrorKind::io, "weir.db: cannot read: Input/output error"); };
  Served served(control);
  RawClient client(served.port());
  const RawResponse response = client.ask("GET /api/status HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(response.status, 500);
  EXPECT_EQ(response.body, "{\"error\":\"weir.db: cannot read: Input/output error\"}\n");
  EXPECT_EQ(client.ask(kHealth).status, 200);
}

TEST(HttpServer, DamagedDatabaseWhileAnswering_EndsTheServersThread) {
  boost::asio::io_context io;
  const HttpServer server(io, {"127.0.0.1", 0}, {}, [](const HttpRequest&) -> HttpResponse {
    throw CorruptDatabase(ErrorKind::io, "weir.db: cannot use the state: database disk image is malformed");
  });
  RawClient client(server.port());
  client.send(kHealth);
  EXPECT_THROW(io.run_for(std::chrono::seconds(5)), CorruptDatabase);
}

TEST(HttpServer, RefusesAPortThatIsTaken) {
  FakeControl control;
  Served served(control);
  boost::asio::io_context io;
  try {
    const HttpServer second(io, {"127.0.0.1", served.port()}, {}, nullptr);
    FAIL() << "it listens";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::io);
    EXPECT_EQ(error.what(),
              cat(served.address(),
                  ": cannot listen: another process does, another weir watch or weir view perhaps; listen on an "
                  "address of its own, as 127.0.0.1:",
                  served.port() ^ 1));
  }
}

TEST(HttpServer, DestructionClosesOpenConnections) {
  FakeControl control;
  Served served(control);
  RawClient idle(served.port());
  EXPECT_EQ(idle.ask(kHealth).status, 200);
  RawClient sending(served.port());
  sending.send("GET /heal");
  served.close();
  EXPECT_TRUE(idle.closed_within(milliseconds(2000)));
  EXPECT_TRUE(sending.closed_within(milliseconds(2000)));
}

}  // namespace
}  // namespace weir::http_server_test
