// kill -9 at random moments over a batch: in the end everything is there, right, and nothing else.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <random>
#include <thread>

#include "format/text.h"
#include "tests/daemon/service_harness.h"

namespace weir::watch_kill_test {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using Names = std::vector<std::string>;

constexpr int kKills = 50;
constexpr int kFiles = 40;

TEST(WatchKill, FiftyKillsLoseNothingAndRedoNothing) {
  ServiceHarness service("jobs = 2\nwork_dir = \"work\"\n", "thumbnails = true\nsettle = 0.05\n");
  fs::create_directory(service.path("work"));
  // Some take a while, so that kills meet conversions in all their stages.
  std::string big(std::size_t{192} * 192 * 192, '\0');
  std::minstd_rand noise;
  for (char& value : big) value = static_cast<char>(noise() >> 20U);
  for (int i = 0; i < kFiles; ++i) {
    if (i % 4 == 0) {
      write_file(service.in(cat("big", i, "_192x192x192_uint8.raw")), big);
    } else {
      service.add(cat("small", i), i + 1);
    }
  }
  std::minstd_rand random(std::random_device{}());
  std::map<std::string, fs::file_time_type> finished;
  for (int kill = 0; kill < kKills; ++kill) {
    service.launch();
    std::this_thread::sleep_for(milliseconds(20 + random() % 280));
    service.kill();
    for (const auto& entry : fs::directory_iterator(service.out())) {
      const std::string name = entry.path().filename().string();
      if (!name.ends_with(".nvdb")) continue;
      // A name is a whole file, at any moment; and one that was whole is not made again.
      const auto [known, is_new] = finished.emplace(name, entry.last_write_time());
      EXPECT_EQ(known->second, entry.last_write_time()) << name << " was converted again after kill " << kill;
      if (is_new) {
        EXPECT_EQ(run_weir({"verify", entry.path().string(), "--progress", "never"}).exit_code, 0) << name;
      }
    }
  }
  service.start();
  ASSERT_TRUE(service.eventually_done(kFiles, std::chrono::seconds(90))) << service.get("/api/status");
  const auto jobs = service.get("/api/jobs?limit=1000");
  for (const auto& job : jobs["jobs"]) EXPECT_EQ(job["attempts"], 0) << job;
  for (const auto& [name, time] : finished) EXPECT_EQ(fs::last_write_time(service.out(name)), time) << name;
  EXPECT_EQ(service.stop(), 0);
  EXPECT_EQ(service.leftovers(), Names{});
  EXPECT_EQ(list_directory(service.path("work")), Names{});
  EXPECT_EQ(list_directory(service.out()).size(), 3U * kFiles);
  for (int i = 0; i < kFiles; i += i < 8 ? 1 : 7) {
    const std::string name =
        i % 4 == 0 ? cat("big", i, "_192x192x192_uint8") : cat("small", i, ServiceHarness::kSuffix);
    EXPECT_EQ(service.difference(name + ".raw", name + ".nvdb"), "");
  }
}

}  // namespace
}  // namespace weir::watch_kill_test
