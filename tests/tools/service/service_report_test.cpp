#include "tools/service/service_report.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/http/api_json.h"

namespace weir::service_report_test {
namespace {

JobView sample_job() {
  JobView job;
  job.id = 24;
  job.source = "/in/a.raw";
  job.state = JobState::done;
  job.source_bytes = 512 << 20;
  job.changed_at = 1000;
  job.outputs.push_back({"/out/a.nvdb", 64 << 20, 8, 51.25, false, true});
  return job;
}

std::string text_of(const std::vector<JobView>& jobs, std::uint64_t total, std::size_t offset = 0) {
  return jobs_text(to_json(JobPage{total, jobs}, JobQuery{{}, {}, offset, 100}), 1062);
}

TEST(ServiceReport, ShowsDurations) {
  EXPECT_EQ(duration_text(0), "0.0 s");
  EXPECT_EQ(duration_text(4.06), "4.1 s");
  EXPECT_EQ(duration_text(62.4), "62 s");
  EXPECT_EQ(duration_text(420), "7 min");
  EXPECT_EQ(duration_text(7300), "2 h");
  EXPECT_EQ(duration_text(259200), "3 days");
}

TEST(ServiceReport, ListsJobs) {
  JobView lossless = sample_job();
  lossless.id = 25;
  lossless.outputs[0].lossless = true;
  lossless.outputs[0].psnr_db.reset();
  lossless.outputs[0].rate = 3.7249;
  JobView several = sample_job();
  several.outputs.push_back(several.outputs[0]);
  JobView failed = sample_job();
  failed.id = 1234567;
  failed.state = JobState::quarantined;
  failed.source = "/in/\x1b[2J.raw";
  failed.outputs.clear();
  failed.reason = "/in/b.raw: 12 bytes are missing";
  EXPECT_EQ(text_of({sample_job(), lossless, several, failed}, 4),
            "     ID  STATE             SIZE         AGE  RESULT                SOURCE\n"
            "     24  done         512.0 MiB        62 s  rate 8, 51.2 dB       /in/a.raw\n"
            "     25  done         512.0 MiB        62 s  rate 3.72, lossless   /in/a.raw\n"
            "     24  done         512.0 MiB        62 s  2 outputs             /in/a.raw\n"
            "1234567  quarantined  512.0 MiB        62 s                        /in/?[2J.raw\n"
            "         /in/b.raw: 12 bytes are missing\n");
}

TEST(ServiceReport, SaysWhichJobsOfTheTotalAreShown) {
  EXPECT_EQ(text_of({}, 0), "no such jobs\n");
  EXPECT_EQ(text_of({}, 7, 100), "no jobs beyond 7\n");
  EXPECT_TRUE(text_of({sample_job(), sample_job()}, 9, 4).ends_with("jobs 5 to 6 of 9; see --limit and --offset\n"));
}

TEST(ServiceReport, ShowsTheStatus) {
  StatusView status;
  status.version = "0.1.0";
  status.config = "/etc/weir.toml";
  status.state = "paused";
  status.reason = "/out is full";
  status.started_at = 1000;
  status.jobs = {0, 15, 2, 24, 1, 2, 0};
  status.queue_age_s = 62;
  status.bytes_per_s = 1.48e8;
  status.done_total = 24;
  status.bytes_in_total = std::uint64_t{12} << 30;
  status.bytes_out_total = std::uint64_t{1536} << 20;
  status.running.push_back({26, "run", "/in/c.raw", "convert", 0.629, 4.1, 100, 0});
  status.running.push_back({27, "run", "/in/d.raw", "verify", std::nullopt, 6, 100, 0});
  status.watches.push_back({"run", "/in", "/out", "inotify", true, "", {0, 15, 2, 24, 1, 0, 0}, 3, std::nullopt});
  status.watches.push_back(
      {"/ct", "/ct", "/ct/nvdb", "poll", false, "it is not there", {0, 0, 0, 0, 0, 2, 0}, 0, std::nullopt});
  EXPECT_EQ(status_text(to_json(status), 1000 + 3 * 86400),
            "service     paused (/out is full), weir 0.1.0, up 3 days, /etc/weir.toml\n"
            "jobs        15 waiting (the oldest for 62 s), 2 running, 24 done, 1 failed, 2 quarantined\n"
            "throughput  141.1 MiB/s in the last minute; since start 24 conversions, 12.0 GiB in, 1.5 GiB out\n"
            "running     26 /in/c.raw: convert, 62 % after 4.1 s\n"
            "running     27 /in/d.raw: verify, 6.0 s\n"
            "watch       run: /in -> /out: inotify, 24 done, 1 failed, 3 queue overflows\n"
            "watch       /ct -> /ct/nvdb: DOWN: it is not there, 0 done, 2 quarantined\n");
}

}  // namespace
}  // namespace weir::service_report_test
