// Tests AMReX plotfiles below a watched directory, with the real `weir watch`. Each is one input and is converted
// when all its files are there, in whatever order they arrive.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "format/base/text.h"
#include "tests/daemon/support/service_harness.h"
#include "tests/support/plotfile_writer.h"

namespace weir::watch_plotfiles_test {
namespace {

namespace fs = std::filesystem;

/// watch = "inotify" (which polls nothing) and watch = "poll" (which opens no inotify).
class WatchPlotfiles : public testing::TestWithParam<const char*> {
 protected:
  static std::string keys() {
    return cat("watch = \"", GetParam(), "\"\nrecursive = true\ndataset = \"Temp\"\nsettle = 0.3\nlossless = true\n");
  }
  static test::PlotfilePlan plan() {
    test::PlotfilePlan plan;
    plan.components = {"density", "Temp"};
    plan.ratios = {{2, 2, 2}};
    plan.boxes.push_back({{{4, 4, 4}, {12, 12, 12}}});
    return plan;
  }
};

INSTANTIATE_TEST_SUITE_P(, WatchPlotfiles, testing::Values("inotify", "poll"),
                         [](const auto& method) { return std::string(method.param); });

TEST_P(WatchPlotfiles, HeaderWrittenFirst_IsWaitedForUntilTheLastLevelIsThere) {
  ServiceHarness service("", keys());
  const std::string all = service.path("elsewhere");
  test::write_plotfile(all, plan());
  service.start();
  const std::string target = service.in("plt00042");
  fs::create_directory(target);
  for (const char* part : {"Header", "Level_0"}) fs::copy(all + '/' + part, target + '/' + part);
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  EXPECT_EQ(service.logged(" start "), 0U);
  EXPECT_EQ(service.count("discovered"), 1U);
  fs::copy(all + "/Level_1", target + "/Level_1");
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  EXPECT_EQ(service.difference("plt00042", "plt00042.nvdb", {"--dataset", "Temp", "--lossless"}), "");
  EXPECT_EQ(service.logged(" start "), 1U);
  EXPECT_EQ(service.leftovers(), std::vector<std::string>{});
  const auto sidecar = ServiceHarness::Json::parse(read_file(service.out("plt00042.nvdb.json")));
  EXPECT_GT(sidecar["source"]["bytes"], fs::file_size(target + "/Header"));
  EXPECT_EQ(service.job("plt00042/Header")["source_bytes"], sidecar["source"]["bytes"]) << "of all its files";
  EXPECT_EQ(service.get("/api/status")["bytes_in_total"], sidecar["source"]["bytes"]);
}

TEST_P(WatchPlotfiles, PlotfileOfTwoDimensions_IsQuarantined) {
  ServiceHarness service("", keys());
  service.start();
  fs::create_directory(service.in("plt00042"));
  write_file(service.in("plt00042/Header"), "HyperCLaw-V1.1\n1\nTemp\n2\n0.25\n0\n");
  EXPECT_TRUE(service.eventually([&] { return service.count("quarantined") == 1; })) << service.log();
  EXPECT_NE(service.log().find("the plotfile is 2-D"), std::string::npos) << service.log();
}

TEST_P(WatchPlotfiles, RenamedDirectories_AreTakenAndCheckpointsAreNot) {
  ServiceHarness service("", keys());
  service.start();
  test::write_plotfile(service.in("plt00001.temp"), plan());
  test::PlotfilePlan checkpoint = plan();
  checkpoint.type = "CheckPointVersion_1.0";
  test::write_plotfile(service.in("chk00001"), checkpoint);
  std::this_thread::sleep_for(std::chrono::milliseconds(1000));
  EXPECT_EQ(service.logged("discovered"), 0U) << service.log();
  fs::rename(service.in("plt00001.temp"), service.in("plt00001"));
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  EXPECT_EQ(service.difference("plt00001", "plt00001.nvdb", {"--dataset", "Temp", "--lossless"}), "");
  EXPECT_EQ(service.logged("discovered"), 1U);
}

TEST_P(WatchPlotfiles, SeparateLevels_AreTheOutputsOfOneJob) {
  ServiceHarness service("", keys() + "levels = \"separate\"\n");
  test::write_plotfile(service.in("plt00042"), plan());
  service.start();
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  const auto made = run_weir({"convert", service.in("plt00042"), "--dataset", "Temp", "--levels", "separate",
                              "--lossless", "-o", service.path("alone.nvdb")});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  std::vector<std::string> outputs;
  const ServiceHarness::Json job = service.job("plt00042/Header");
  for (const auto& output : job["outputs"]) outputs.push_back(output["path"]);
  ASSERT_EQ(outputs.size(), 2U);
  for (const std::string level : {"0", "1"}) {
    const std::string output = service.out("plt00042_level_" + level + ".nvdb");
    EXPECT_NE(std::find(outputs.begin(), outputs.end(), output), outputs.end()) << output;
    EXPECT_EQ(read_file(output), read_file(service.path("alone_level_" + level + ".nvdb")));
  }
  EXPECT_EQ(service.leftovers(), std::vector<std::string>{});
}

}  // namespace
}  // namespace weir::watch_plotfiles_test
