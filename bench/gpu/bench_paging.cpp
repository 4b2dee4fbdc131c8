// weir_bench_paging FILE.nvdb [--spp N] [--size N] [--scene FILE] [--frames N]: path tracing with all bricks of a file
// on the device, and with caches of a half and a quarter of them: frames a second of a camera that stands still, a
// picture of N samples, and an orbit with its worst frame, each against all bricks in the same run. Pictures must have
// the same bits; exits with 1 where they have not, 2 for anything wrong.
#include <cuda_runtime_api.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "format/base/seconds_since.h"
#include "format/base/text.h"
#include "format/nanovdb/nvdb_file.h"
#include "gpu/cuda/render/brick_volume.h"
#include "gpu/cuda/render/render_kernel.h"
#include "gpu/cuda/render/trace_paged.h"
#include "gpu/cuda/volume/device_memory.h"
#include "gpu/render/render_setup.h"

namespace weir {
namespace {

using Clock = std::chrono::steady_clock;

struct Options {
  std::string file;
  RenderMode mode = RenderMode::path;
  std::uint32_t samples = 64;
  std::int32_t size = 1024;
  int frames = 360;
};

RenderMode mode_of(const std::string& name) {
  for (const RenderMode mode : {RenderMode::path, RenderMode::dvr, RenderMode::iso, RenderMode::mip}) {
    if (render_mode_name(mode) == name) return mode;
  }
  throw Error(ErrorKind::usage, cat("--mode ", name, ": use path, dvr, iso or mip"));
}

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const auto number = [&] {
      if (++i == argc) throw Error(ErrorKind::usage, cat(argument, " needs a number"));
      return static_cast<std::int32_t>(parse_int(argv[i]).value());
    };
    if (argument == "--spp") {
      options.samples = static_cast<std::uint32_t>(number());
    } else if (argument == "--size") {
      options.size = number();
    } else if (argument == "--frames") {
      options.frames = number();
    } else if (argument == "--mode" && i + 1 < argc) {
      options.mode = mode_of(argv[++i]);
    } else {
      options.file = argument;
    }
  }
  if (options.file.empty()) throw Error(ErrorKind::usage, "usage: weir_bench_paging FILE.nvdb");
  return options;
}

struct Frame {
  double seconds = 0;
  PagedReport report;
  std::vector<Float3> sums;
};

class Bench {
 public:
  explicit Bench(const Options& options) : options_(options), file_(options.file), cells_(file_.grid(), 32) {
    scene_.mode = options.mode;
  }

  const NvdbGrid& grid() const { return file_.grid(); }

  std::unique_ptr<BrickVolume> load(std::uint64_t memory) {
    LoadOptions how;
    how.packed = true;
    const auto start = Clock::now();
    DeviceGrid loaded = load_grid(file_, {}, how);
    transfer_s_ = seconds_since(start);
    auto volume =
        std::make_unique<BrickVolume>(grid(), GridBytes(std::move(loaded)), cells_.bounds(), BrickBudget{memory});
    load_s_ = seconds_since(start);
    return volume;
  }
  double transfer_s() const { return transfer_s_; }
  double load_s() const { return load_s_; }

  void stand_at(double azimuth) {
    scene_.camera.azimuth = azimuth;
    RenderOptions render;
    render.width = render.height = options_.size;
    setup_ = std::make_unique<RenderSetup>(volume_info(grid(), cells_), cells_, scene_, render);
  }

  /// Samples [first, last) of each pixel.
  Frame draw(BrickVolume& volume, std::uint32_t first, std::uint32_t last) {
    const DeviceTransfer transfer(setup_->transfer_function());
    volume.cells().update(transfer, cudaStreamPerThread);
    const auto task_of = [&](const auto& sampler) {
      auto task = setup_->bare_task(sampler);
      task.medium.transfer = transfer.bounds().transfer;
      task.medium.cell_opacity = volume.cells().majorants();
      task.medium.cell_values = volume.cells().bounds();
      return task;
    };
    DeviceArray<Float3> sums(static_cast<std::size_t>(options_.size) * static_cast<std::size_t>(options_.size));
    check_cuda(cudaMemsetAsync(sums.data(), 0, sums.bytes(), cudaStreamPerThread), "clearing");
    check_cuda(cudaStreamSynchronize(cudaStreamPerThread), "clearing");
    Frame frame;
    const auto start = Clock::now();
    if (volume.cache().paged()) {
      frame.report =
          trace_paged<Filter::trilinear>(volume.cache(), task_of, first, last, sums, nullptr, [](std::uint64_t) {});
    } else {
      launch_render(task_of(volume.cache().sampler<Filter::trilinear>()), first, last, sums.data(),
                    cudaStreamPerThread);
    }
    check_cuda(cudaStreamSynchronize(cudaStreamPerThread), "rendering");
    frame.seconds = seconds_since(start);
    frame.sums = sums.download();
    return frame;
  }

 private:
  const Options& options_;
  NvdbFile file_;
  Scene scene_;
  MacrocellGrid cells_;
  std::unique_ptr<RenderSetup> setup_;
  double transfer_s_ = 0;
  double load_s_ = 0;
};

/// Seconds of one frame of one sample, camera still, once it has settled.
double settled(Bench& bench, BrickVolume& volume) {
  for (std::uint32_t i = 0; i < 4; ++i) bench.draw(volume, i, i + 1);
  std::vector<double> seconds;
  for (std::uint32_t i = 4; i < 20; ++i) seconds.push_back(bench.draw(volume, i, i + 1).seconds);
  std::ranges::sort(seconds);
  return seconds[seconds.size() / 2];
}

/// A cache of about that many bricks.
std::unique_ptr<BrickVolume> cache_of(Bench& bench, std::uint64_t bricks, std::uint64_t most) {
  std::uint64_t memory = std::min<std::uint64_t>(most, bricks * 1600 + (256U << 20U));
  auto volume = bench.load(memory);
  for (int i = 0; i < 3; ++i) {
    const std::uint64_t there = volume->cache().bricks();
    if (there * 50 > bricks * 49 && there * 50 < bricks * 51) break;
    const auto off = (static_cast<std::int64_t>(bricks) - static_cast<std::int64_t>(there)) * 1500;
    memory = static_cast<std::uint64_t>(std::max<std::int64_t>(static_cast<std::int64_t>(memory) + off, 64 << 20));
    volume.reset();
    volume = bench.load(memory);
  }
  return volume;
}

bool run(const Options& options) {
  use_device(0);
  Bench bench(options);
  const std::uint64_t free = free_device_bytes(~std::uint64_t{0}) - kSpareDeviceBytes;
  bench.stand_at(35);
  auto all = bench.load(free);
  if (all->cache().paged()) throw Error(ErrorKind::usage, "all bricks do not fit on this device");
  const BrickCounters counters = all->cache().counters();
  const std::uint64_t bricks = all->cache().bricks() - counters.free_slots;
  std::printf("%s, %s: loaded in %.3f s (transfer %.3f s), %llu bricks, %.2f decodes a brick, %.2f GB, %s\n",
              options.file.substr(options.file.rfind('/') + 1).c_str(),
              std::string(render_mode_name(options.mode)).c_str(), bench.load_s(), bench.transfer_s(),
              static_cast<unsigned long long>(bricks),
              static_cast<double>(counters.decoded) / static_cast<double>(counters.built),
              static_cast<double>(all->cache().bytes()) / 1e9, all->cache().texels_note().c_str());
  const double still = settled(bench, *all);
  const Frame whole = bench.draw(*all, 0, options.samples);
  std::printf("%-8s %9s %9s %7s %9s %7s %7s %8s %9s %7s %7s %7s %s\n", "share", "bricks", "still ms", "ratio",
              "picture s", "ratio", "turns", "tiles", "decodes", "orbit", "worst", "settled", "bits");
  std::printf("%-8s %9llu %9.3f %7.3f %9.3f %7.3f\n", "all", static_cast<unsigned long long>(bricks), 1e3 * still, 1.0,
              whole.seconds, 1.0);
  std::fflush(stdout);
  bool same = true;
  for (const double share : {0.5, 0.25}) {
    bench.stand_at(35);
    auto some = cache_of(bench, static_cast<std::uint64_t>(share * static_cast<double>(bricks)), free);
    const double some_still = settled(bench, *some);
    const Frame picture = bench.draw(*some, 0, options.samples);
    const bool equal = picture.sums == whole.sums;
    same = same && equal;
    double sum = 0;
    double all_sum = 0;
    double worst = 1e9;
    double after = 1e9;  // worst of the third frame after one, camera still
    const int rest = std::max(1, options.frames / 6);
    for (int i = 0; i < options.frames; ++i) {
      bench.stand_at(35 + 360.0 * i / options.frames);
      const auto sample = static_cast<std::uint32_t>(i);
      const double a = bench.draw(*all, sample, sample + 1).seconds;
      const double b = bench.draw(*some, sample, sample + 1).seconds;
      sum += b;
      all_sum += a;
      if (i > 0) worst = std::min(worst, a / b);
      if (i % rest == rest - 1) {
        bench.draw(*some, sample, sample + 1);
        bench.draw(*some, sample, sample + 1);
        after = std::min(after, a / bench.draw(*some, sample, sample + 1).seconds);
      }
    }
    std::printf("%-8.2f %9llu %9.3f %7.3f %9.3f %7.3f %7llu %8u %9.2f %7.3f %7.3f %7.3f %s\n", share,
                static_cast<unsigned long long>(some->cache().bricks()), 1e3 * some_still, still / some_still,
                picture.seconds, whole.seconds / picture.seconds, static_cast<unsigned long long>(picture.report.turns),
                picture.report.least_tiles,
                static_cast<double>(some->cache().counters().decoded) /
                    static_cast<double>(std::max<std::uint64_t>(some->cache().counters().built, 1)),
                all_sum / sum, worst, after, equal ? "same" : "OTHER");
    std::fflush(stdout);
  }
  return same;
}

}  // namespace
}  // namespace weir

int main(int argc, char** argv) {
  try {
    return weir::run(weir::parse(argc, argv)) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "weir_bench_paging: %s\n", error.what());
    return 2;
  }
}
