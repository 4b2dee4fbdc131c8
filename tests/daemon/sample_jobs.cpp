#include "tests/daemon/sample_jobs.h"

#include <chrono>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <vector>

#include "format/text.h"
#include "gpu/image_output.h"

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

// A plume that rises with the step.
Image plume(int step) {
  Image image;
  image.width = 256;
  image.height = 192;
  const float rise = static_cast<float>(step) / kSteps;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const float u = (static_cast<float>(x) + 0.5F) / 256 - 0.5F;
      const float v = 1 - (static_cast<float>(y) + 0.5F) / 192;
      const float width = 0.05F + 0.25F * v * (0.4F + rise);
      const float top = std::exp(-8 * std::max(v - 0.15F - 0.75F * rise, 0.0F));
      const float sway = 0.06F * std::sin(9 * v - 6 * rise);
      const float d = (u - sway) / width;
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

void add_results(FakeControl& control, const std::filesystem::path& directory, double now) {
  for (int step = kSteps; step >= 1; --step) {
    JobView job = job_of(step, cat(kRun, '/', step_name(step), ".raw"), JobState::done, now - 40 * (kSteps - step) - 5);
    job.seconds = 6.4;
    job.peak_rss_bytes = std::uint64_t{430} << 20;
    OutputView output{
        cat(kRun, "/nvdb/", step_name(step), ".nvdb"), kSourceBytes / 8, 8, 51.3 + 0.1 * step, false, true};
    if (step == 20) {
      output.lossless = true;
      output.psnr_db.reset();
      output.rate = 3.72;
      output.bytes = 144'304'128;
    }
    job.outputs.push_back(output);
    const std::filesystem::path picture = directory / cat(step, ".png");
    const std::vector<std::byte> png = encode_png(plume(step), {});
    std::ofstream(picture, std::ios::binary)
        .write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
    control.thumbnails[{step, 0}] = picture.string();
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
  control.all.push_back(job_of(300, cat(kRun, '/', step_name(42), ".raw"), JobState::discovered, now - 1));
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
  WatchView run{kRun, kRun, kRun + "/nvdb", "inotify", true, "", {}, 1, control.all.front()};
  run.jobs[static_cast<std::size_t>(JobState::done)] = kSteps;
  WatchView ct{kCt, kCt, kCt + "/nvdb", "poll", true, "", {}, 0, std::nullopt};
  status.watches = {run, ct};
}

}  // namespace weir
