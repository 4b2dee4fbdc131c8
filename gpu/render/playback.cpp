#include "gpu/render/playback.h"

#include <chrono>
#include <future>
#include <memory>
#include <utility>

#include "format/base/error.h"
#include "format/base/seconds_since.h"
#include "gpu/render/volume_error.h"

namespace weir {

namespace {

using Clock = std::chrono::steady_clock;

// Returns what `work` returns and adds its time to `seconds`. Each stage has its own sum.
template <class Work>
auto timed(double& seconds, const Work& work) {
  struct Stop {
    double& seconds;
    Clock::time_point start = Clock::now();
    ~Stop() { seconds += seconds_since(start); }
  };
  const Stop stop{seconds};
  return work();
}

}  // namespace

std::string_view PlaybackReport::limit() const {
  if (load_s >= render_s && load_s >= write_s) return "load";
  return render_s >= write_s ? "render" : "write";
}

PlaybackReport play(Backend& backend, std::span<const std::string> files, const Scene& scene,
                    const RenderOptions& options, const SampleOptions& sampling, const FrameWriter& write) {
  PlaybackReport report;
  const Clock::time_point start = Clock::now();
  Clock::time_point first_written = start;
  // Each stage has at most one thread: it is waited for before the stage's next one starts. A future of std::async
  // waits in its destructor, so no thread outlives this function.
  const auto load = [&](const std::string& path, std::unique_ptr<LoadedVolume> reuse) {
    const auto loaded = [&] { return backend.load(std::make_shared<const NvdbFile>(path), 0, std::move(reuse)); };
    return timed(report.load_s, [&] { return naming_volume(path, loaded); });
  };
  std::unique_ptr<LoadedVolume> done;
  std::future<std::unique_ptr<LoadedVolume>> loading;
  std::future<void> writing;
  const auto start_load = [&](std::size_t step) {
    if (step == files.size()) return;
    loading = std::async(std::launch::async, load, std::cref(files[step]), std::move(done));
  };
  RenderOptions alike = options;
  start_load(0);
  for (std::size_t step = 0; step < files.size(); ++step) {
    std::unique_ptr<LoadedVolume> volume;
    try {
      volume = loading.get();
    } catch (const Error& error) {
      // If there is no room for two volumes, there may be room for one.
      if (error.kind() != ErrorKind::io || !done) throw;
      done.reset();
      volume = load(files[step], nullptr);
    }
    start_load(step + 1);
    if (!alike.density_frame) alike.density_frame = volume->info().frame;
    const auto rendered = [&] { return backend.render(*volume, scene, alike, sampling); };
    Picture picture = timed(report.render_s, [&] { return naming_volume(files[step], rendered); });
    report.load = volume->load_summary();
    done = std::move(volume);
    if (writing.valid()) writing.get();
    writing = std::async(std::launch::async, [&, step, picture = std::move(picture)] {
      timed(report.write_s, [&] { write(step, picture); });
      if (step == 0) first_written = Clock::now();
    });
  }
  if (writing.valid()) writing.get();
  report.frames = files.size();
  report.total_s = seconds_since(start);
  const bool several = report.frames > 1;
  const double frames = static_cast<double>(several ? report.frames - 1 : report.frames);
  report.sustained = frames / (several ? seconds_since(first_written) : report.total_s);
  return report;
}

}  // namespace weir
