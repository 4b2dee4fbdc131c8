#include "daemon/jobs/conversion_task.h"

#include <gtest/gtest.h>

namespace weir::conversion_task_test {
namespace {

WatchConfig make_watch() {
  WatchConfig watch;
  watch.directory = "/in";
  watch.output = "/out";
  watch.convert_options = {"--rate=4"};
  return watch;
}

TEST(ConversionTask, OutputDirectoryMirrorsTheSourceTree) {
  const WatchConfig watch = make_watch();
  EXPECT_EQ(output_directory(watch, "/in/a.raw"), "/out");
  EXPECT_EQ(output_directory(watch, "/in/deep/er/a.raw"), "/out/deep/er");
}

TEST(ConversionTask, SourceBelowTheWatchedDirectory_LiesInTheWatch) {
  WatchConfig watch = make_watch();
  EXPECT_TRUE(is_source_of(watch, "/in/a.raw"));
  EXPECT_TRUE(is_source_of(watch, "/in/deep/a.raw"));
  EXPECT_FALSE(is_source_of(watch, "/inside/a.raw"));
  EXPECT_FALSE(is_source_of(watch, "/old/a.raw"));
  watch.directory = "/";
  EXPECT_TRUE(is_source_of(watch, "/a.raw"));
}

TEST(ConversionTask, TakesItsValuesFromServiceWatchAndJob) {
  ServiceConfig service;
  service.memory = kDaemonMemory + (std::uint64_t{256 + 160} << 20U);
  service.viewer_memory = std::uint64_t{160} << 20U;
  service.jobs = 2;
  service.bandwidth = 1001;
  service.threads = 3;
  service.nice = 4;
  service.io_class = IoClass::idle;
  service.work_dir = "/spill";
  Job job;
  job.source = "/in/deep/a.raw";
  job.identity = {5, 6, 7};
  const ConversionTask task = make_task("/bin/weir", service, make_watch(), job);
  EXPECT_EQ(task.program, "/bin/weir");
  EXPECT_EQ(task.source, "/in/deep/a.raw");
  EXPECT_EQ(task.identity, job.identity);
  EXPECT_EQ(task.output, "/out/deep/");
  EXPECT_EQ(task.convert_options, std::vector<std::string>{"--rate=4"});
  EXPECT_EQ(task.memory, std::uint64_t{128} << 20U);
  EXPECT_EQ(task.bandwidth, 500U);
  EXPECT_EQ(task.threads, 3);
  EXPECT_EQ(task.nice, 4);
  EXPECT_EQ(task.io_class, IoClass::idle);
  EXPECT_EQ(task.work_dir, "/spill");
}

TEST(ConversionTask, ShareOfALowBandwidthLimit_IsAtLeastOneByte) {
  ServiceConfig service;
  service.jobs = 8;
  EXPECT_EQ(make_task("", service, make_watch(), {}).bandwidth, 0U);
  service.bandwidth = 7;
  EXPECT_EQ(make_task("", service, make_watch(), {}).bandwidth, 1U);
}

TEST(ConversionTask, OutputNameFollowsThePatternOfTheWatch) {
  WatchConfig watch = make_watch();
  watch.name = "{stem}_{step}.nvdb";
  Job job;
  job.source = "/in/a.raw";
  EXPECT_EQ(make_task("", {}, watch, job).output, "/out/{stem}_{step}.nvdb");
}

TEST(ConversionTask, OptionsTextChangesOnlyWithSettingsOfTheOutput) {
  const WatchConfig watch = make_watch();
  EXPECT_EQ(options_text(watch), "output=/out/ --rate=4");
  WatchConfig other = watch;
  other.settle_s = 9;
  other.priority = Priority::newest;
  other.convert_options.push_back("--backend=cpu");  // these options do not change the bytes
  other.convert_options.push_back("--direct-io=off");
  EXPECT_EQ(options_text(other), options_text(watch));
  other.name = "x.nvdb";
  EXPECT_NE(options_text(other), options_text(watch));
}

}  // namespace
}  // namespace weir::conversion_task_test
