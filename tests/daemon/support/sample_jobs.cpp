#include "tests/daemon/support/sample_jobs.h"

#include <chrono>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <initializer_list>
#include <utility>
#include <vector>

#include "format/base/text.h"
#include "gpu/image/image_output.h"

namespace weir {
namespace {

constexpr std::uint64_t kSourceBytes = std::uint64_t{512} << 20;
constexpr int kSteps = 24;
const std::string kRun = "/scratch/run42";
const std::string kCt = "/archive/ct";

double unix_time() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::string step_name(int step) { return cat("density_", step, "_512x512x512_float32"); }

// Returns a picture of a plume that rises with the step.
Image plume(int step, int width, int height) {
  Image image;
  image.width = width;
  image.height = height;
  const float rise = static_cast<float>(step) / kSteps;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const float u = (static_cast<float>(x) + 0.5F) / static_cast<float>(width) - 0.5F;
      const float v = 1 - (static_cast<float>(y) + 0.5F) / static_cast<float>(height);
      const float reach = 0.05F + 0.25F * v * (0.4F + rise);
      const float top = std::exp(-8 * std::max(v - 0.15F - 0.75F * rise, 0.0F));
      const float sway = 0.06F * std::sin(9 * v - 6 * rise);
      const float d = (u - sway) / reach;
      const float density = std::exp(-d * d) * top;
      image.pixels.push_back({density, density * density * 0.75F, 0.08F + 0.25F * density * density * density});
    }
  }
  return image;
}

JobView job_of(int id, const std::string& source, JobState state, double changed_at) {
  JobView job;
  job.id = id;
  job.watch = kRun;
  job.source = source;
  job.state = state;
  job.source_bytes = kSourceBytes;
  job.discovered_at = changed_at - 30;
  job.changed_at = changed_at;
  return job;
}

void add_thumbnail(FakeControl& control, const std::filesystem::path& directory, int id, const Image& image) {
  const std::filesystem::path picture = directory / cat(id, ".png");
  const std::vector<std::byte> png = encode_png(image, {});
  std::ofstream(picture, std::ios::binary)
      .write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
  control.thumbnails[{id, 0}] = picture.string();
}

void add_results(FakeControl& control, const std::filesystem::path& directory, double now) {
  for (int step = kSteps; step >= 1; --step) {
    JobView job = job_of(step, cat(kRun, '/', step_name(step), ".raw"), JobState::done, now - 40 * (kSteps - step) - 5);
    job.seconds = 6.4;
    job.peak_rss_bytes = std::uint64_t{430} << 20;
    OutputView output{
        cat(kRun, "/nvdb/", step_name(step), ".nvdb"), kSourceBytes / 8, 8, 51.3 + 0.1 * step, false, true};
    output.max_error = 0.001 * step;
    output.min = -0.02 * step;
    output.max = 1 + 0.05 * step;
    if (step == 20) {
      output.lossless = true;
      output.max_error = 0;
      output.psnr_db.reset();
      output.rate = 3.72;
      output.bytes = 144'304'128;
    }
    job.outputs.push_back(output);
    add_thumbnail(control, directory, step, plume(step, 256, 192));
    control.all.push_back(job);
  }
}

void add_problems(FakeControl& control, double now) {
  JobView failed = job_of(101, kRun + "/density_9_512x512x512_float32.raw", JobState::failed, now - 400);
  failed.attempts = 5;
  failed.exit_code = 5;
  failed.reason = failed.source + ": read: Input/output error at byte 134217728; check the disk, then retry";
  failed.log_tail = "09:12:01 info survey: 128 of 512 MiB\n09:12:01 error " + failed.reason + '\n';
  control.all.push_back(failed);
  JobView bad = job_of(102, kCt + "/patient <b>7.nrrd", JobState::quarantined, now - 7300);
  bad.watch = kCt;
  bad.attempts = 1;
  bad.exit_code = 3;
  bad.reason = bad.source + ": line 5: sizes: 512 512: 3 numbers are needed, found 2";
  control.all.push_back(bad);
}

void add_queue(FakeControl& control, double now) {
  JobView again = job_of(200, cat(kRun, '/', step_name(25), ".raw"), JobState::waiting, now - 62);
  again.attempts = 1;
  again.next_attempt_at = now + 45;
  again.reason = again.source + ": read: Resource temporarily unavailable";
  control.all.push_back(again);
  JobView changing = job_of(300, cat(kRun, '/', step_name(42), ".raw"), JobState::discovered, now - 1);
  changing.reason = "it changed a moment ago";
  control.all.push_back(changing);
  for (int step = 28; step < 42; ++step) {
    control.all.push_back(job_of(200 + step, cat(kRun, '/', step_name(step), ".raw"), JobState::waiting, now - 20));
  }
}

void add_running(FakeControl& control, double now) {
  for (const int step : {26, 27}) {
    control.all.push_back(job_of(200 + step, cat(kRun, '/', step_name(step), ".raw"), JobState::running, now - 4));
  }
  control.now.running = {
      {226, kRun, cat(kRun, '/', step_name(26), ".raw"), "convert", 0.62, 4.1, kSourceBytes, std::uint64_t{410} << 20},
      {227, kRun, cat(kRun, '/', step_name(27), ".raw"), "verify", std::nullopt, 6.9, kSourceBytes,
       std::uint64_t{90} << 20}};
}

void set_counts(WatchView& watch, std::initializer_list<std::pair<JobState, std::uint64_t>> counts) {
  watch.jobs = {};
  for (const auto& [state, count] : counts) watch.jobs[static_cast<std::size_t>(state)] = count;
}

// Adds fifteen truncated files.
void add_alike_problems(FakeControl& control, double now) {
  for (int i = 0; i < 15; ++i) {
    JobView cut = job_of(401 + i, cat(kRun, "/pressure_", i + 1, ".raw"), JobState::quarantined, now - 100 - 10 * i);
    cut.attempts = 1;
    cut.exit_code = 3;
    cut.source_bytes = static_cast<std::uint64_t>(100 + i);
    cut.reason = cat("has ", 100 + i, " bytes and should have 512; write it again");
    control.all.push_back(cut);
  }
}

void add_files_not_taken(FakeControl& control, double now) {
  const std::string open = "a program has it open for writing";
  const std::vector<std::string> reasons{open, "it changed a moment ago", "it has 100 of 512 bytes",
                                         "its marker *.done is not there"};
  for (std::size_t i = 0; i < 12; ++i) {
    const int n = static_cast<int>(i);
    JobView job = job_of(301 + n, cat(kRun, "/velocity_", n + 1, ".raw"), JobState::discovered, now - 500 + 10 * n);
    job.reason = i < reasons.size() ? reasons[i] : open;
    control.all.push_back(job);
  }
}

// Returns a name of 180 letters.
std::string long_name(const std::string& begin, const std::string& end) {
  return cat(begin, std::string(180 - begin.size() - end.size(), 'x'), end);
}

void add_long_names(FakeControl& control, double now) {
  const auto path = [](int step) {
    return cat(kRun, '/', long_name("pressure_of_the_left_wing_", cat("_step_", step, ".raw")));
  };
  control.all.push_back(job_of(502, path(0), JobState::waiting, now - 10));
  JobView changing = job_of(503, path(1), JobState::discovered, now - 600);
  changing.reason = "it changed a moment ago";
  control.all.push_back(changing);
  JobView nameless = job_of(504, path(2), JobState::quarantined, now - 50);
  nameless.attempts = 2;
  nameless.exit_code = 3;
  nameless.reason = nameless.source + ": the name gives no size; write NAME_XxYxZ_float32.raw";
  control.all.push_back(nameless);
  control.all.push_back(job_of(505, kRun + "/stopped.raw", JobState::cancelled, now - 5000));
}

// Adds the results of the second watch: three, and one with a long name in front.
void add_scans(FakeControl& control, const std::filesystem::path& directory, double now) {
  const auto scan = [&](int id, const std::string& source, double changed_at, double psnr_db, double max_error,
                        int width, int height) {
    JobView job = job_of(id, source, JobState::done, changed_at);
    job.watch = kCt;
    job.seconds = 2.5;
    const std::string stem = std::filesystem::path(source).stem().string();
    OutputView output{cat(kCt, "/nvdb/", stem, ".nvdb"), std::uint64_t{64} << 20, 8, psnr_db, false, true};
    output.max_error = max_error;
    output.min = -1000;
    output.max = 3000;
    job.outputs.push_back(output);
    add_thumbnail(control, directory, id, plume(12, width, height));
    return job;
  };
  control.all.push_back(scan(511, kCt + "/scan_1.nrrd", now - 3000, 80, 1e-6, 300, 100));
  control.all.push_back(scan(512, kCt + "/scan_2.nrrd", now - 2999, 70, 1e-4, 200, 200));
  control.all.push_back(scan(513, kCt + "/scan_3.nrrd", now - 2998, 60, 1e-2, 64, 64));
  const std::string name = long_name("scan_of_the_left_wing_", "_step_4.raw");
  control.all.insert(control.all.begin(), scan(501, cat(kCt, '/', name), now - 2, 50, 0.05, 120, 300));
}

}  // namespace

void show_sample_jobs(FakeControl& control, const std::filesystem::path& directory) {
  const double now = unix_time();
  add_results(control, directory, now);
  add_problems(control, now);
  add_queue(control, now);
  add_running(control, now);
  StatusView& status = control.now;
  status.version = "0.1.0";
  status.config = "/home/sim/run42/weir.toml";
  status.state = "running";
  status.started_at = now - 3 * 86400;
  status.queue_age_s = 62;
  status.bytes_per_s = 1.48e8;
  status.jobs_at_once = 2;
  status.done_total = kSteps;
  status.bytes_in_total = kSteps * kSourceBytes;
  status.bytes_out_total = kSteps * kSourceBytes / 8;
  status.arrived = {12.5, 1.2e8};
  status.converted = {11.0, 1.1e8};
  status.waiting_bytes = 15 * kSourceBytes;
  status.queue_ends_in_s = 75;
  status.disks = {{"/scratch", {kRun + "/nvdb"}, 1'200'000'000'000, 4'000'000'000'000, 1.5e7, 79000.0, ""},
                  {"/archive", {kCt + "/nvdb"}, 15'000'000'000'000, 20'000'000'000'000, 0, std::nullopt, ""}};
  WatchView run{kRun, kRun, kRun + "/nvdb", "inotify", true, "", {}, 1, control.all.front()};
  run.waiting_bytes = status.waiting_bytes;
  run.done_per_min = 11;
  set_counts(run,
             {{JobState::done, kSteps}, {JobState::waiting, 15}, {JobState::failed, 1}, {JobState::discovered, 1}});
  WatchView ct{kCt, kCt, kCt + "/nvdb", "poll", true, "", {}, 0, std::nullopt};
  set_counts(ct, {{JobState::quarantined, 1}});
  status.watches = {run, ct};
}

void show_busy_sample(FakeControl& control, const std::filesystem::path& directory) {
  show_sample_jobs(control, directory);
  const double now = unix_time();
  OutputView& unknown = control.all[kSteps - 12].outputs[0];  // the output of step 12, made by an older weir
  unknown.psnr_db = unknown.max_error = unknown.min = unknown.max = std::nullopt;
  add_alike_problems(control, now);
  add_files_not_taken(control, now);
  add_long_names(control, now);
  add_scans(control, directory, now);
  StatusView& status = control.now;
  status.running[1].stall = "nothing done by verify for 75 s: it waits for a device or a file server";
  status.arrived = {30.0, 2.9e8};
  status.queue_ends_in_s.reset();
  status.disks[0].free_bytes = 1'288'490'189;  // 1.2 GiB
  status.disks[0].fills_in_s = 86;
  status.disks[0].held = "no room in /scratch/run42/nvdb, where 1.2 GiB are free; what needs more waits for it";
  set_counts(status.watches[0], {{JobState::done, kSteps},
                                 {JobState::waiting, 16},
                                 {JobState::failed, 1},
                                 {JobState::quarantined, 16},
                                 {JobState::discovered, 14},
                                 {JobState::cancelled, 1}});
  set_counts(status.watches[1], {{JobState::done, 4}, {JobState::quarantined, 1}});
  status.watches[1].last_done = control.all.front();
}

}  // namespace weir
