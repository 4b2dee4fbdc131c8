// Tests the viewer of the running service: a real `weir view` behind it, opened over HTTP, and its page in a real
// browser.
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>

#include "format/base/text.h"
#include "ingest/files/numbered_series.h"
#include "tests/daemon/support/raw_client.h"
#include "tests/daemon/support/service_harness.h"
#include "tests/support/python.h"
#include "tests/support/sanitized.h"

namespace weir::watch_viewer_test {
namespace {

using Json = nlohmann::json;

class WatchViewer : public testing::Test {
 protected:
  /// Converts s_1 and s_2. Returns the ID of the job of s_1.
  std::int64_t start(ServiceHarness& service) {
    service.add("s_1", 1);
    service.add("s_2", 2);
    service.start();
    EXPECT_TRUE(service.eventually_done(2)) << service.log();
    return service.job(cat("s_1", ServiceHarness::kSuffix, ".raw"))["id"];
  }
  static bool ready(const ServiceHarness& service) {
    return ServiceHarness::eventually([&] { return service.get("/api/viewer")["state"] == "ready"; });
  }
  static std::uint16_t port(const ServiceHarness& service) {
    return static_cast<std::uint16_t>(std::stoi(read_file(service.path("port"))));
  }
  static RawResponse ask(const ServiceHarness& service, const std::string& target, const std::string& more = "") {
    RawClient client(port(service));
    return client.ask(cat("GET ", target, " HTTP/1.1\r\nHost: localhost\r\n", more, "\r\n"));
  }
  /// Returns the viewer's process: the service's only child.
  static pid_t viewer_process(const ServiceHarness& service) {
    const Json viewer = service.get("/api/viewer");
    const CommandResult found = run_command({"pgrep", "-f", cat("^weir view ", viewer["file"].get<std::string>())});
    return found.exit_code == 0 ? std::stoi(found.out) : 0;
  }
};

constexpr const char* kSocket =
    "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
    "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Protocol: weir.view\r\n";

TEST_F(WatchViewer, IsStartedAtTheFileOfAJob_AndAnsweredBehindView) {
  ServiceHarness service;
  const std::int64_t job = start(service);
  EXPECT_EQ(ask(service, "/view/").status, 503);
  EXPECT_EQ(service.get("/api/status")["viewer"]["state"], "none");
  const Json asked = service.post(cat("/api/jobs/", job, "/view"));
  EXPECT_EQ(asked["state"], "starting") << asked;
  const std::string series = series_digest(service.out("s_9" + std::string(ServiceHarness::kSuffix) + ".nvdb"));
  EXPECT_EQ(asked["url"],
            cat("/view/?series=", series, "&job=", job, "&output=0#f=s_1", ServiceHarness::kSuffix, ".nvdb"));
  EXPECT_EQ(asked["memory_bytes"], 192 << 20) << "of 1 GiB";
  ASSERT_TRUE(ready(service)) << service.get("/api/viewer");
  const RawResponse page = ask(service, "/view/");
  EXPECT_EQ(page.status, 200);
  EXPECT_NE(page.body.find("<title>weir view</title>"), std::string::npos);
  EXPECT_NE(page.header("Content-Security-Policy").find("connect-src 'self' ws://localhost"), std::string::npos);
  const Json state = service.get("/view/api/state");
  EXPECT_EQ(state["steps"],
            (Json{cat("s_1", ServiceHarness::kSuffix, ".nvdb"), cat("s_2", ServiceHarness::kSuffix, ".nvdb")}));
  EXPECT_EQ(state["grows"], true);
  EXPECT_EQ(state["series"], series);
  EXPECT_EQ(state["allow_convert"], false);
  EXPECT_EQ(ask(service, "/view/ws", kSocket).status, 101);
  EXPECT_EQ(ask(service, "/view/ws?series=" + series, kSocket).status, 101);
  EXPECT_EQ(ask(service, "/view/ws?series=0", kSocket).status, 409);
  EXPECT_EQ(ask(service, "/view/ws", cat(kSocket, "Origin: http://evil.example\r\n")).status, 403);
  EXPECT_EQ(ask(service, "/view/weir.db").status, 404);
  EXPECT_EQ(service.logged(" viewer "), 1U) << service.log();
  EXPECT_EQ(service.stop(), 0);
}

TEST_F(WatchViewer, ThatWasKilled_HarmsNothingAndIsStartedAgain) {
  ServiceHarness service;
  const std::int64_t job = start(service);
  service.post(cat("/api/jobs/", job, "/view"));
  ASSERT_TRUE(ready(service));
  const pid_t process = viewer_process(service);
  ASSERT_GT(process, 0);
  ::kill(process, SIGKILL);
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.get("/api/viewer")["state"] == "failed"; }));
  EXPECT_EQ(service.get("/api/viewer")["reason"],
            "view was ended by signal 9 (Killed); the system may have been out of memory");
  service.add("s_3", 3);
  EXPECT_TRUE(service.eventually_done(3));
  service.post(cat("/api/jobs/", job, "/view"));
  EXPECT_TRUE(ready(service));
  const pid_t next = viewer_process(service);
  EXPECT_NE(next, process);
  service.kill();
  EXPECT_TRUE(ServiceHarness::eventually([&] { return ::kill(next, 0) != 0; })) << "it ends with the service";
}

TEST_F(WatchViewer, WhatCannotBeViewed_IsSaid) {
  ServiceHarness service("viewer_memory = 0\n");
  const std::int64_t job = start(service);
  EXPECT_EQ(service.get("/api/viewer")["state"], "off");
  EXPECT_EQ(service.post(cat("/api/jobs/", job, "/view"))["error"],
            "viewers are off: viewer_memory is 0 in the configuration");
  service.configure("viewer_memory = \"128MiB\"\n", "");
  service.signal(SIGHUP);
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.get("/api/viewer")["state"] == "none"; }));
  EXPECT_EQ(service.post("/api/jobs/99/view")["error"], "there is no job 99");
  EXPECT_EQ(service.post(cat("/api/jobs/", job, "/view?output=1"))["error"], cat("job ", job, " has no output 1"));
  const std::string output = service.out(cat("s_1", ServiceHarness::kSuffix, ".nvdb"));
  std::filesystem::remove(output);
  service.post(cat("/api/jobs/", job, "/view"));
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.get("/api/viewer")["state"] != "starting"; }));
  EXPECT_EQ(service.get("/api/viewer")["reason"],
            cat(output, ": is not there; name another file of its series, such as ",
                service.out(cat("s_2", ServiceHarness::kSuffix, ".nvdb"))));
}

TEST_F(WatchViewer, Page_OpensItAndShowsStepsThatCome) {
  if (std::system("command -v chromium >/dev/null && command -v chromedriver >/dev/null") != 0) {
    GTEST_SKIP() << "chromium or chromedriver is not installed; see tools/setup.sh";
  }
  // A sanitizer's own memory counts against the forecast's share.
  ServiceHarness service(cat("token = \"secret\"\n", kSanitized ? "viewer_memory = \"512MiB\"\n" : ""),
                         "thumbnails = true\n");
  service.add("s_1", 1);
  service.start();
  CommandOptions options;
  options.timeout = std::chrono::minutes(5);  // for a browser on a busy machine
  const CommandResult result = run_command({kPython, "-B", WEIR_SOURCE_DIR "/tests/daemon/page/viewer_test.py",
                                            cat("http://127.0.0.1:", port(service)), service.in(), "secret"},
                                           options);
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err << service.log();
}

}  // namespace
}  // namespace weir::watch_viewer_test
