// Tests the running service: signals, reloads and HTTP requests.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <thread>

#include "format/base/text.h"
#include "format/io/descriptor.h"
#include "format/io/file_system.h"
#include "tests/daemon/support/service_harness.h"

namespace weir::watch_control_test {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using Names = std::vector<std::string>;

/// Adds a source whose conversion takes seconds: a gibibyte of zeros that takes no disk space.
std::string add_long(const ServiceHarness& service) {
  const std::string name = "long_1024x1024x1024_uint8.raw";
  write_file(service.path("long.tmp"), "");
  fs::resize_file(service.path("long.tmp"), std::uintmax_t{1} << 30U);
  fs::rename(service.path("long.tmp"), service.in(name));
  return name;
}

/// Returns the files in the output directory without the work files of `name`.
Names outputs_without_leftovers(const ServiceHarness& service, const std::string& name) {
  Names names = list_directory(service.out());
  std::erase_if(names, [&](const std::string& path) { return path.starts_with(cat(".", name, ".nvdb.work/")); });
  return names;
}

bool started(const ServiceHarness& service) {
  return ServiceHarness::eventually([&] {
    const auto status = service.get("/api/status");
    return status.is_object() && !status["running"].empty() && status["running"][0]["fraction"].is_number();
  });
}

TEST(WatchControl, SigtermLetsRunningJobsFinish) {
  ServiceHarness service("grace = 600\n");
  service.start();
  const std::string name = add_long(service);
  ASSERT_TRUE(started(service)) << service.log();
  EXPECT_EQ(service.stop(), 0);
  EXPECT_TRUE(fs::exists(service.out("long_1024x1024x1024_uint8.nvdb")));
  EXPECT_EQ(service.logged(" done "), 1U) << service.log();
}

TEST(WatchControl, SigtermStopsJobsThatOutlastTheGracePeriod) {
  ServiceHarness service("grace = 0.1\n");
  service.start();
  add_long(service);
  ASSERT_TRUE(started(service)) << service.log();
  EXPECT_EQ(service.stop(), 0);
  EXPECT_EQ(outputs_without_leftovers(service, "long_1024x1024x1024_uint8"), Names{});
  EXPECT_EQ(service.logged(" stopped "), 1U) << service.log();
  fs::remove(service.in("long_1024x1024x1024_uint8.raw"));
}

TEST(WatchControl, ASecondSigtermEndsItAtOnce) {
  ServiceHarness service("grace = 600\n");
  service.start();
  add_long(service);
  ASSERT_TRUE(started(service)) << service.log();
  service.signal(SIGTERM);
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.logged(" stop ") == 1; }));
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(service.stop(), 0);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));
  EXPECT_FALSE(fs::exists(service.out("long_1024x1024x1024_uint8.nvdb")));
}

TEST(WatchControl, CancelPauseResumeAndRetry) {
  ServiceHarness service;
  service.start();
  add_long(service);
  ASSERT_TRUE(started(service)) << service.log();
  const auto running = service.get("/api/status")["running"][0];
  EXPECT_EQ(running["step"], "convert");
  EXPECT_GT(running["rss_bytes"], 0);
  const std::string job = cat("/api/jobs/", running["id"].get<int>());
  EXPECT_EQ(service.post(job + "/cancel")["state"], "cancelled");
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.get("/api/status")["running"].empty(); }));
  EXPECT_EQ(outputs_without_leftovers(service, "long_1024x1024x1024_uint8"), Names{});
  EXPECT_EQ(service.count("cancelled"), 1U);

  EXPECT_EQ(service.post("/api/pause")["state"], "paused");
  const std::string small = service.add("small");
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.count("waiting") == 1; })) << service.log();
  std::this_thread::sleep_for(milliseconds(300));
  EXPECT_EQ(service.count("waiting"), 1U);
  EXPECT_EQ(service.post("/api/resume")["state"], "running");
  ASSERT_TRUE(service.eventually_done(1)) << service.log();

  service.post(job + "/retry");
  ASSERT_TRUE(started(service)) << service.log();
  service.post(job + "/cancel");
}

TEST(WatchControl, ShowsRatesDisksAndTheErrorOfOutputs) {
  ServiceHarness service;
  service.add("before");
  service.start();
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  EXPECT_EQ(service.get("/api/status")["arrived_per_min"], 0) << "it was there at the start";
  const std::string name = service.add("after");
  ASSERT_TRUE(service.eventually_done(2)) << service.log();
  EXPECT_TRUE(ServiceHarness::eventually([&] { return service.get("/api/status")["disks"].size() == 1; }));
  const auto status = service.get("/api/status");
  EXPECT_GT(status["arrived_per_min"], 0);
  EXPECT_GT(status["arrived_bytes_per_s"], 0);
  const auto done = status["done_per_min"].get<double>();
  EXPECT_NEAR(done, 2 * status["arrived_per_min"].get<double>(), 0.3 * done);
  EXPECT_NEAR(status["watches"][0]["done_per_min"].get<double>(), done, 0.3 * done);
  EXPECT_EQ(status["waiting_bytes"], 0);
  EXPECT_EQ(status["queue_ends_in_s"], 0);
  ASSERT_EQ(status["disks"].size(), 1U);
  EXPECT_EQ(status["disks"][0]["directories"], Names{service.out().substr(0, service.out().size() - 1)});
  EXPECT_GT(status["disks"][0]["free_bytes"], 0);
  EXPECT_EQ(status["disks"][0]["held"], "");
  const auto output = service.job(name + ".raw")["outputs"][0];
  const auto sidecar = nlohmann::json::parse(read_file(service.out(name + ".nvdb.json")));
  EXPECT_EQ(output["max_error"], sidecar["error"]["max_abs"]);
  EXPECT_EQ(output["min"], 0);
  EXPECT_EQ(output["max"], 255);
}

TEST(WatchControl, SaysWhyAFileIsNotTakenYet) {
  ServiceHarness service;
  service.add("first");
  service.start();
  ASSERT_TRUE(service.eventually_done(1)) << "else the file may be found, not seen as it is made: " << service.log();
  const std::string whole = ServiceHarness::volume(1);
  const Descriptor file(::open(service.in("open_24x20x16_uint8.raw").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644));
  ASSERT_EQ(::write(file.get(), whole.data(), 100), 100);
  const auto reason = [&] { return service.job("open_24x20x16_uint8.raw").value("reason", ""); };
  EXPECT_TRUE(ServiceHarness::eventually([&] { return reason() == "a program has it open for writing"; })) << reason();
}

TEST(WatchControl, Retry_DoneJob_ConvertsAgainOnlyWithForce) {
  ServiceHarness service;
  const std::string name = service.add("a");
  service.start();
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  const auto made = fs::last_write_time(service.out(name + ".nvdb"));
  const std::string retry = cat("/api/jobs/", service.job(name + ".raw")["id"].get<int>(), "/retry");
  service.post(retry);
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.logged(" info done ") == 2; })) << service.log();
  EXPECT_EQ(fs::last_write_time(service.out(name + ".nvdb")), made);
  service.post(retry + "?force=1");
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.logged(" info done ") == 3; })) << service.log();
  EXPECT_GT(fs::last_write_time(service.out(name + ".nvdb")), made);
  service.post(retry);  // the force is used up after one run
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.logged(" info done ") == 4; })) << service.log();
  EXPECT_EQ(service.logged("converted=yes"), 2U);
  EXPECT_EQ(service.logged("converted=\"no, done already\""), 2U) << service.log();
  fs::remove(service.in(name + ".raw"));
  EXPECT_EQ(service.post(retry)["error"], "job 1 is done, and its source is gone: nothing to retry");
  EXPECT_EQ(service.count("done"), 1U);
}

TEST(WatchControl, ABadReloadChangesNothingAndAGoodOneTakesEffect) {
  ServiceHarness service;
  service.start();
  service.add("one");
  ASSERT_TRUE(service.eventually_done(1)) << service.log();

  service.configure("", "colour = \"blue\"\n");
  service.signal(SIGHUP);
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.logged(" reload-rejected ") == 1; })) << service.log();
  EXPECT_NE(service.log().find("colour"), std::string::npos);
  service.add("two", 5);
  ASSERT_TRUE(service.eventually_done(2)) << service.log();

  fs::create_directory(service.path("more"));
  service.configure("", "size = \"400000\"\n");
  service.signal(SIGHUP);
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.logged(" reload config=") == 1; })) << service.log();
  // With other options, done jobs are converted again.
  ASSERT_TRUE(ServiceHarness::eventually([&] {
    return fs::file_size(service.out(std::string("one") + ServiceHarness::kSuffix + ".nvdb")) == 400000 &&
           fs::file_size(service.out(std::string("two") + ServiceHarness::kSuffix + ".nvdb")) == 400000;
  })) << service.log();
}

// At a start, such a path gives exit code 5.
TEST(WatchControl, ReloadWithAPathThatCannotBeUsed_ChangesNothing) {
  ServiceHarness service;
  service.start();
  service.add("one");
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  service.configure("work_dir = \"missing\"\n", "size = \"400000\"\n");
  service.signal(SIGHUP);
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.logged(" reload-rejected ") == 1; })) << service.log();
  EXPECT_EQ(service.logged("/missing: work_dir cannot be written to by user "), 1U) << service.log();
  EXPECT_EQ(service.count("done"), 1U) << "not to be done anew";
  EXPECT_EQ(service.logged(" reload config="), 0U) << service.log();
}

TEST(WatchControl, ReloadOfAnUnchangedConfiguration_LeavesWhatRunsAlone) {
  ServiceHarness service;
  service.start();
  const std::string name = add_long(service);
  ASSERT_TRUE(started(service)) << service.log();
  const auto picture = make_posix_file_system()->create(service.out("a.nvdb.png.partial"));
  service.signal(SIGHUP);
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.logged(" reload config=") == 1; })) << service.log();
  EXPECT_TRUE(fs::exists(service.out("a.nvdb.png.partial")));
  EXPECT_EQ(service.logged("cleaned "), 0U) << service.log();
  service.kill();
  fs::remove(service.in(name));
}

TEST(WatchControl, ReloadWithoutAWatch_FinishesItsJobAndForgetsWaitingOnes) {
  ServiceHarness service;
  service.start();
  const std::string running = add_long(service);
  ASSERT_TRUE(started(service)) << service.log();
  const std::string waiting = service.add("waiting");
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.count("waiting") == 1; })) << service.log();

  fs::create_directory(service.path("other"));
  const std::string with = read_file(service.path("weir.toml"));
  std::string without = with;
  without.replace(without.find("directory = \"in\""), 16, "directory = \"other\"");
  write_file(service.path("weir.toml"), without);
  service.signal(SIGHUP);
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.count("waiting") == 0; })) << service.log();
  EXPECT_EQ(service.count("running"), 1U);
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  EXPECT_EQ(service.get("/api/jobs")["total"], 1);
  EXPECT_EQ(service.get("/api/status")["queue_age_s"], 0);
  EXPECT_EQ(service.logged(" start "), 1U);

  write_file(service.path("weir.toml"), with);
  service.signal(SIGHUP);
  ASSERT_TRUE(service.eventually_done(2)) << service.log();
  EXPECT_EQ(service.difference(waiting + ".raw", waiting + ".nvdb"), "");
  EXPECT_EQ(service.logged(" start "), 2U) << "the first one is known";
}

// Otherwise an output would lie as far from the output directory as its source from the new directory.
TEST(WatchControl, WatchGivenAnotherDirectory_ForgetsJobsOfTheFormerOne) {
  ServiceHarness service("", "label = \"w\"\n");
  service.start();
  service.post("/api/pause");
  service.add("old");
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.count("waiting") == 1; })) << service.log();
  fs::create_directory(service.path("other"));
  std::string text = read_file(service.path("weir.toml"));
  text.replace(text.find("directory = \"in\""), 16, "directory = \"other\"");
  write_file(service.path("weir.toml"), text);
  service.signal(SIGHUP);
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.count("waiting") == 0; })) << service.log();
  write_file(service.path(std::string("other/new") + ServiceHarness::kSuffix + ".raw"), ServiceHarness::volume(3));
  service.post("/api/resume");
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  EXPECT_EQ(service.get("/api/jobs")["total"], 1);
  EXPECT_TRUE(fs::exists(service.out(std::string("new") + ServiceHarness::kSuffix + ".nvdb")));
  EXPECT_EQ(service.logged(" start "), 1U);
}

TEST(WatchControl, RenamedLog_IsReopenedOnSighup) {
  ServiceHarness service("log_size = \"0\"\n");
  service.start();
  fs::rename(service.path("log"), service.path("log.1"));
  service.signal(SIGHUP);
  ASSERT_TRUE(ServiceHarness::eventually([&] { return fs::exists(service.path("log")); }));
  service.add("one");
  ASSERT_TRUE(service.eventually_done(1));
  EXPECT_EQ(service.logged(" done "), 1U);
}

// logrotate renames the log whether or not the configuration is valid.
TEST(WatchControl, RenamedLog_IsReopenedThoughTheConfigurationIsRefused) {
  ServiceHarness service("log_size = \"0\"\n");
  service.start();
  service.configure("", "colour = \"blue\"\n");
  fs::rename(service.path("log"), service.path("log.1"));
  service.signal(SIGHUP);
  ASSERT_TRUE(ServiceHarness::eventually([&] { return fs::exists(service.path("log")); }));
  EXPECT_TRUE(ServiceHarness::eventually([&] { return service.logged(" reload-rejected ") == 1; })) << service.log();
}

TEST(WatchControl, TwoDaemonsDoNotShareAStateFile) {
  ServiceHarness service;
  service.start();
  const CommandResult second = run_weir({"watch", service.path("weir.toml")});
  EXPECT_EQ(second.exit_code, 5) << second.err;
  EXPECT_NE(second.err.find("weir.db"), std::string::npos) << second.err;
  EXPECT_TRUE(service.running());
}

TEST(WatchControl, NotifiesTheServiceManager) {
  const TemporaryDirectory directory;
  const Descriptor manager(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = directory / "notify";
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  ASSERT_EQ(::bind(manager.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  std::string received;
  const auto receive = [&] {
    std::array<char, 512> text{};
    for (ssize_t n; (n = ::recv(manager.get(), text.data(), text.size(), MSG_DONTWAIT)) > 0;) {
      received.append(text.data(), static_cast<std::size_t>(n)).append("\n");
    }
    return received;
  };
  ::setenv("NOTIFY_SOCKET", path.c_str(), 1);
  ::setenv("WATCHDOG_USEC", "300000", 1);
  ServiceHarness service;
  service.start();
  ::unsetenv("NOTIFY_SOCKET");
  ::unsetenv("WATCHDOG_USEC");
  EXPECT_TRUE(ServiceHarness::eventually([&] { return receive().find("READY=1\n") != std::string::npos; }));
  EXPECT_TRUE(ServiceHarness::eventually([&] { return receive().find("WATCHDOG=1\n", 60) != std::string::npos; }));
  EXPECT_EQ(service.stop(), 0);
  EXPECT_NE(receive().find("STOPPING=1\n"), std::string::npos);
}

TEST(WatchControl, ThumbnailsAreWrittenAndListed) {
  ServiceHarness service("", "thumbnails = true\n");
  service.start();
  const std::string name = service.add("one");
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  EXPECT_TRUE(
      ServiceHarness::eventually([&] { return service.job(name + ".raw")["outputs"][0]["thumbnail"].get<bool>(); }));
  EXPECT_TRUE(fs::exists(service.out(name + ".nvdb.png")));
  EXPECT_EQ(service.leftovers(), Names{});
}

}  // namespace
}  // namespace weir::watch_control_test
