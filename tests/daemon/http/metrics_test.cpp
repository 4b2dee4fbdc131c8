#include "daemon/http/metrics.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "format/base/text.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir::metrics_test {
namespace {

StatusView sample_status() {
  StatusView status;
  status.version = "0.1.0";
  status.state = "paused";
  status.started_at = 1795253270.125;
  status.queue_age_s = 12.5;
  status.bytes_per_s = 1e9;
  status.jobs[static_cast<std::size_t>(JobState::done)] = 41;
  status.jobs[static_cast<std::size_t>(JobState::failed)] = 1;
  status.done_total = 41;
  status.bytes_in_total = 12345678901234;
  status.running.push_back({3, "run", "/in/c.raw", "convert", 0.5, 2, 100, 1000});
  status.running.push_back({4, "run", "/in/d.raw", "verify", 0.5, 2, 100, 500});
  WatchView watch;
  watch.label = "/in \"x\"\\y\nz";
  watch.method = "poll";
  watch.up = true;
  watch.overflows = 2;
  watch.last_done.emplace();
  watch.last_done->changed_at = 1795253271.5;
  watch.last_done->outputs.push_back({"/out/a.nvdb", 1000, 4, 40.0, false, false});
  watch.last_done->outputs.push_back({"/out/b.nvdb", 2000, 8.25, 51.5, false, false});
  status.watches.push_back(watch);
  status.disks.push_back({"/scratch", {"/scratch/out"}, 1000, 4000, 2.5, {}, ""});
  return status;
}

// Returns the lines of `text` that begin with `prefix`, joined.
std::string lines_with(const std::string& text, const std::string& prefix) {
  std::string found;
  for (const std::string& line : split(text, '\n')) {
    if (line.starts_with(prefix)) found += line + '\n';
  }
  return found;
}

TEST(Metrics, ShowTheService) {
  MetricsView metrics;
  metrics.errors = {{"input", 3}, {"io", 1}};
  metrics.reloads = 2;
  metrics.log_lines_lost = 7;
  const std::string text = metrics_text(sample_status(), metrics, {123456, 17, 5});
  EXPECT_EQ(lines_with(text, "weir_build_info"), "weir_build_info{version=\"0.1.0\"} 1\n");
  EXPECT_EQ(lines_with(text, "weir_start_time"), "weir_start_time_seconds 1795253270.125\n");
  EXPECT_EQ(lines_with(text, "weir_paused"), "weir_paused 1\n");
  EXPECT_EQ(lines_with(text, "weir_jobs"),
            "weir_jobs{state=\"discovered\"} 0\nweir_jobs{state=\"waiting\"} 0\nweir_jobs{state=\"running\"} 0\n"
            "weir_jobs{state=\"done\"} 41\nweir_jobs{state=\"failed\"} 1\nweir_jobs{state=\"quarantined\"} 0\n"
            "weir_jobs{state=\"cancelled\"} 0\n");
  EXPECT_EQ(lines_with(text, "weir_queue_age"), "weir_queue_age_seconds 12.5\n");
  EXPECT_EQ(lines_with(text, "weir_source_bytes"), "weir_source_bytes_total 12345678901234\n");
  EXPECT_EQ(lines_with(text, "weir_throughput"), "weir_throughput_bytes_per_second 1e+09\n");
  EXPECT_EQ(lines_with(text, "weir_errors"), "weir_errors_total{kind=\"input\"} 3\nweir_errors_total{kind=\"io\"} 1\n");
  EXPECT_EQ(lines_with(text, "weir_config"),
            "weir_config_reloads_total{result=\"applied\"} 2\nweir_config_reloads_total{result=\"rejected\"} 0\n");
  EXPECT_EQ(lines_with(text, "weir_log"), "weir_log_lines_lost_total 7\n");
  EXPECT_EQ(lines_with(text, "weir_resident"), "weir_resident_memory_bytes 123456\n");
  EXPECT_EQ(lines_with(text, "weir_conversions_resident"), "weir_conversions_resident_memory_bytes 1500\n");
  EXPECT_EQ(lines_with(text, "weir_open_descriptors"), "weir_open_descriptors 17\n");
  EXPECT_EQ(lines_with(text, "weir_threads"), "weir_threads 5\n");
}

TEST(Metrics, EscapeLabels) {
  const std::string text = metrics_text(sample_status(), {}, {});
  EXPECT_EQ(lines_with(text, "weir_watch_up"), "weir_watch_up{watch=\"/in \\\"x\\\"\\\\y\\nz\",method=\"poll\"} 1\n");
}

TEST(Metrics, ShowWhetherAnOutputIsMountedIfTheWatchNamesAMountPoint) {
  StatusView status = sample_status();
  status.watches[0].label = "run";
  EXPECT_EQ(lines_with(metrics_text(status, {}, {}), "weir_watch_output"), "");
  status.watches[0].output_mounted = true;
  EXPECT_EQ(lines_with(metrics_text(status, {}, {}), "weir_watch_output"),
            "weir_watch_output_mounted{watch=\"run\"} 1\n");
  status.watches[0].output_mounted = false;
  EXPECT_EQ(lines_with(metrics_text(status, {}, {}), "weir_watch_output"),
            "weir_watch_output_mounted{watch=\"run\"} 0\n");
}

TEST(Metrics, ShowTheNewestResultOfAWatch) {
  StatusView status = sample_status();
  status.watches[0].label = "run";
  const std::string lossy = metrics_text(status, {}, {});
  EXPECT_EQ(lines_with(lossy, "weir_last_result"),
            "weir_last_result_timestamp_seconds{watch=\"run\"} 1795253271.5\n"
            "weir_last_result_bytes{watch=\"run\"} 2000\nweir_last_result_rate{watch=\"run\"} 8.25\n"
            "weir_last_result_lossless{watch=\"run\"} 0\nweir_last_result_psnr_db{watch=\"run\"} 51.5\n");
  EXPECT_EQ(lines_with(lossy, "weir_inotify_overflows"), "weir_inotify_overflows_total{watch=\"run\"} 2\n");
  OutputView& output = status.watches[0].last_done->outputs.back();
  output.lossless = true;
  output.psnr_db.reset();
  EXPECT_EQ(lines_with(metrics_text(status, {}, {}), "weir_last_result_psnr"),
            "weir_last_result_psnr_db{watch=\"run\"} +Inf\n");
  status.watches[0].last_done.reset();
  EXPECT_EQ(lines_with(metrics_text(status, {}, {}), "weir_last_result"), "");
}

TEST(Metrics, CountConversionsCumulatively) {
  MetricsView metrics;
  for (const double seconds : {0.05, 0.1, 0.2, 7.0, 1e6}) metrics.conversion_seconds.observe(seconds);
  const std::string text = metrics_text({}, metrics, {});
  EXPECT_EQ(lines_with(text, "weir_conversion_seconds"),
            "weir_conversion_seconds_bucket{le=\"0.1\"} 2\nweir_conversion_seconds_bucket{le=\"0.25\"} 3\n"
            "weir_conversion_seconds_bucket{le=\"0.5\"} 3\nweir_conversion_seconds_bucket{le=\"1\"} 3\n"
            "weir_conversion_seconds_bucket{le=\"2.5\"} 3\nweir_conversion_seconds_bucket{le=\"5\"} 3\n"
            "weir_conversion_seconds_bucket{le=\"10\"} 4\nweir_conversion_seconds_bucket{le=\"30\"} 4\n"
            "weir_conversion_seconds_bucket{le=\"60\"} 4\nweir_conversion_seconds_bucket{le=\"120\"} 4\n"
            "weir_conversion_seconds_bucket{le=\"300\"} 4\nweir_conversion_seconds_bucket{le=\"900\"} 4\n"
            "weir_conversion_seconds_bucket{le=\"3600\"} 4\nweir_conversion_seconds_bucket{le=\"14400\"} 4\n"
            "weir_conversion_seconds_bucket{le=\"+Inf\"} 5\nweir_conversion_seconds_sum 1000007.35\n"
            "weir_conversion_seconds_count 5\n");
}

TEST(Metrics, ShowFreeAndTotalBytesOfOutputDisks) {
  EXPECT_EQ(
      lines_with(metrics_text(sample_status(), {}, {}), "weir_output_disk"),
      "weir_output_disk_free_bytes{disk=\"/scratch\"} 1000\nweir_output_disk_size_bytes{disk=\"/scratch\"} 4000\n");
}

// While other disks have room, the service is not paused.
TEST(Metrics, TellWhichDisksHoldJobs) {
  StatusView status = sample_status();
  status.state = "running";
  status.disks.push_back({"/data", {"/data/out"}, 0, 4000, 0, {}, "no room in /data/out"});
  const std::string text = metrics_text(status, {}, {});
  EXPECT_EQ(lines_with(text, "weir_disk_held"),
            "weir_disk_held{disk=\"/scratch\"} 0\nweir_disk_held{disk=\"/data\"} 1\n");
  EXPECT_EQ(lines_with(text, "weir_paused"), "weir_paused 0\n");
  EXPECT_EQ(
      lines_with(text, "# HELP weir_paused"),
      "# HELP weir_paused 1 while no new conversion is started: asked for, the state file cannot be written, or no "
      "output's disk, or not that of work_dir, has room.\n");
}

TEST(Metrics, PassPromtoolCheck) {
  if (std::system("command -v promtool >/dev/null") != 0) GTEST_SKIP() << "promtool is not installed";
  const TemporaryDirectory directory;
  write_file(directory / "metrics", metrics_text(sample_status(), {}, {}));
  const CommandResult result = run_command({"sh", "-c", "promtool check metrics <\"$1\"", "sh", directory / "metrics"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out + result.err, "");
}

// The format's rules: HELP, TYPE, then the samples of this name; each name once.
TEST(Metrics, NameEveryFamilyOnce) {
  const std::string text = metrics_text(sample_status(), {}, {});
  ASSERT_TRUE(text.ends_with('\n'));
  std::set<std::string> names;
  std::string name;
  for (const std::string& line : split(text.substr(0, text.size() - 1), '\n')) {
    if (line.starts_with("# HELP ")) {
      name = split(line, ' ')[2];
      EXPECT_TRUE(name.starts_with("weir_")) << name;
      EXPECT_TRUE(names.insert(name).second) << name;
    } else if (line.starts_with("# TYPE ")) {
      const std::vector<std::string> words = split(line, ' ');
      ASSERT_EQ(words.size(), 4U);
      EXPECT_EQ(words[2], name);
      EXPECT_EQ(words[3] == "counter", name.ends_with("_total")) << name;
    } else {
      EXPECT_TRUE(line.starts_with(name)) << line;
    }
  }
}

}  // namespace
}  // namespace weir::metrics_test
