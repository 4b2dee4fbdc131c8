// weir_bench_paging FILE.nvdb [--mode M] [--spp N] [--size N] [--frames N] [--lod BIAS] [--scattered N]: compares
// pictures with all bricks of a file on the device to pictures with caches of a half and a quarter of the bricks.
// Measures frames a second of a still camera, a picture of N samples, and an orbit with its worst frame, each against
// all bricks in the same run. With levels of detail, the reference still uses only voxels, and the table tells how far
// the picture is off. Pictures from caches must have the same bits as from all bricks; exits with 1 if not, 2 for any
// other failure.
#include <cuda_runtime_api.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
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
  std::optional<LevelOfDetail> levels = std::nullopt;
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
    const auto level = [&] {
      if (!options.levels) options.levels.emplace();
      return static_cast<float>(number());
    };
    if (argument == "--spp") {
      options.samples = static_cast<std::uint32_t>(number());
    } else if (argument == "--size") {
      options.size = number();
    } else if (argument == "--frames") {
      options.frames = number();
    } else if (argument == "--lod") {
      const float bias = level();
      options.levels->bias = bias;
    } else if (argument == "--scattered") {
      const float scattered = level();
      options.levels->scattered = scattered;
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
  std::uint32_t missed = 0;  // pixels
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
    BrickBudget budget{memory};
    if (options_.levels) budget.levels = bytes_for_levels(memory);
    auto volume = std::make_unique<BrickVolume>(grid(), GridBytes(std::move(loaded)), cells_.bounds(), budget);
    load_s_ = seconds_since(start);
    return volume;
  }
  double transfer_s() const { return transfer_s_; }
  double load_s() const { return load_s_; }

  void stand_at(double azimuth) {
    scene_.camera.azimuth = azimuth;
    RenderOptions render;
    render.width = render.height = options_.size;
    render.levels = options_.levels;
    setup_ = std::make_unique<RenderSetup>(volume_info(grid(), cells_), cells_, scene_, render);
  }
  const std::optional<LevelsUsed>& levels() const { return setup_->levels(); }

  /// Whether frames do without missing bricks.
  void draft(bool on) { draft_ = on; }
  double pixels() const { return static_cast<double>(options_.size) * options_.size; }
  /// Draws samples [first, last) of each pixel, with levels of detail from `finest` on; 0: only voxels.
  Frame draw(BrickVolume& volume, std::uint32_t first, std::uint32_t last, int finest) {
    if (finest == 0)
      return draw_seen(
          volume, first, last, [](const auto& sampler) { return sampler; }, 0);
    const LevelsView<TextureSampler> levels = volume.levels(finest).view();
    return draw_seen(
        volume, first, last,
        [&]<class Fine>(const Fine& fine) {
          return LevelledVolume<Fine, TextureSampler>{fine, levels, setup_->levels()->choice};
        },
        finest);
  }

 private:
  template <class Seen>
  Frame draw_seen(BrickVolume& volume, std::uint32_t first, std::uint32_t last, const Seen& seen, int finest) {
    const DeviceTransfer transfer(setup_->transfer_function());
    DeviceMacrocells& cells = finest > 0 ? levelled_ : volume.cells();
    if (finest == 0) cells.update(transfer, cudaStreamPerThread);
    const auto task_of = [&](const auto& sampler) {
      auto task = setup_->bare_task(seen(sampler));
      task.medium.transfer = transfer.bounds().transfer;
      task.medium.cell_opacity = cells.majorants();
      task.medium.cell_values = cells.bounds();
      return task;
    };
    DeviceArray<Float3> sums(static_cast<std::size_t>(options_.size) * static_cast<std::size_t>(options_.size));
    check_cuda(cudaMemsetAsync(sums.data(), 0, sums.bytes(), cudaStreamPerThread), "clearing");
    check_cuda(cudaStreamSynchronize(cudaStreamPerThread), "clearing");
    Frame frame;
    const auto start = Clock::now();
    if (finest > 0) {  // part of a frame, because the cells change with the camera
      levelled_ = volume.levelled_cells(finest, cells_.lattice(), setup_->levels()->choice, draft_);
      levelled_.update(transfer, cudaStreamPerThread);
    }
    const auto draw_paged = [&]<class Sampler>(const Sampler&) {
      if (draft_) {
        frame.missed = trace_draft<Sampler>(volume.cache(), task_of, first, last, sums, [](std::uint64_t) {}).missed;
      } else {
        frame.report = trace_paged<Sampler>(volume.cache(), task_of, first, last, sums, nullptr, [](std::uint64_t) {});
      }
    };
    if (volume.cache().paged() && options_.mode == RenderMode::path) {
      volume.cache().with_paged_sampler<Filter::trilinear, Noting::called>(draw_paged);
    } else if (volume.cache().paged()) {
      volume.cache().with_paged_sampler<Filter::trilinear, Noting::inlined>(draw_paged);
    } else {
      launch_render(task_of(volume.cache().sampler<Filter::trilinear>()), first, last, sums.data(),
                    cudaStreamPerThread);
    }
    check_cuda(cudaStreamSynchronize(cudaStreamPerThread), "rendering");
    frame.seconds = seconds_since(start);
    frame.sums = sums.download();
    return frame;
  }

  const Options& options_;
  NvdbFile file_;
  Scene scene_;
  MacrocellGrid cells_;
  std::unique_ptr<RenderSetup> setup_;
  DeviceMacrocells levelled_{std::vector<MinMax>()};  // for pictures with levels
  bool draft_ = false;
  double transfer_s_ = 0;
  double load_s_ = 0;
};

/// Returns the seconds of one frame of one sample with a still camera, once the frames have settled.
double settled(Bench& bench, BrickVolume& volume, int finest) {
  for (std::uint32_t i = 0; i < 4; ++i) bench.draw(volume, i, i + 1, finest);
  std::vector<double> seconds;
  for (std::uint32_t i = 4; i < 20; ++i) seconds.push_back(bench.draw(volume, i, i + 1, finest).seconds);
  std::ranges::sort(seconds);
  return seconds[seconds.size() / 2];
}

/// Returns a cache of about `bricks` bricks.
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

/// Results of a camera that goes around the volume: a cache against all bricks.
struct Orbit {
  double ratio = 0;           // ratio of the frames' speed
  double worst = 1e9;         // worst ratio of a frame
  double settled = 1e9;       // worst ratio of the third further frame of a still camera
  double missed = 0;          // largest share of the pixels that missed a brick
  double missed_settled = 0;  // the same for such third frames
};

Orbit orbit(Bench& bench, BrickVolume& all, BrickVolume& some, int finest, int frames) {
  Orbit found;
  double sum = 0;
  double all_sum = 0;
  const int rest = std::max(1, frames / 6);
  for (int i = 0; i < frames; ++i) {
    bench.stand_at(35 + 360.0 * i / frames);
    const auto sample = static_cast<std::uint32_t>(i);
    const double a = bench.draw(all, sample, sample + 1, 0).seconds;
    const Frame frame = bench.draw(some, sample, sample + 1, finest);
    sum += frame.seconds;
    all_sum += a;
    if (i > 0) {
      found.worst = std::min(found.worst, a / frame.seconds);
      found.missed = std::max(found.missed, frame.missed / bench.pixels());
    }
    if (i % rest == rest - 1) {
      bench.draw(some, sample, sample + 1, finest);
      bench.draw(some, sample, sample + 1, finest);
      const Frame third = bench.draw(some, sample, sample + 1, finest);
      found.settled = std::min(found.settled, a / third.seconds);
      found.missed_settled = std::max(found.missed_settled, third.missed / bench.pixels());
    }
  }
  found.ratio = all_sum / sum;
  return found;
}

/// Returns decibels relative to the largest value of `expected`, over all channels.
double psnr(const std::vector<Float3>& found, const std::vector<Float3>& expected) {
  double squares = 0;
  double peak = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Float3 d = found[i] - expected[i];
    squares += static_cast<double>(dot(d, d)) / 3;
    peak = std::max(peak, static_cast<double>(max_component(expected[i])));
  }
  return 10 * std::log10(peak * peak * static_cast<double>(found.size()) / squares);
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
  std::string of_levels;
  if (options.levels) of_levels = cat(", lod ", options.levels->bias, ", scattered ", options.levels->scattered);
  std::printf("%s, %s%s: loaded in %.3f s (transfer %.3f s), %llu bricks, %.2f decodes a brick, %.2f GB, %s\n",
              options.file.substr(options.file.rfind('/') + 1).c_str(),
              std::string(render_mode_name(options.mode)).c_str(), of_levels.c_str(), bench.load_s(),
              bench.transfer_s(), static_cast<unsigned long long>(bricks),
              static_cast<double>(counters.decoded) / static_cast<double>(counters.built),
              static_cast<double>(all->cache().bytes()) / 1e9, all->cache().texels_note().c_str());
  const double still = settled(bench, *all, 0);
  const Frame voxels = bench.draw(*all, 0, options.samples, 0);
  std::printf("%-8s %9s %9s %7s %9s %7s %7s %8s %9s %7s %7s %7s %s\n", "share", "bricks", "still ms", "ratio",
              "picture s", "ratio", "turns", "tiles", "decodes", "orbit", "worst", "settled", "bits");
  const auto row_of_all = [&](const char* name, double still_s, double picture_s) {
    std::printf("%-8s %9llu %9.3f %7.3f %9.3f %7.3f", name, static_cast<unsigned long long>(bricks), 1e3 * still_s,
                still / still_s, picture_s, voxels.seconds / picture_s);
  };
  row_of_all("all", still, voxels.seconds);
  std::printf("\n");
  Frame whole = voxels;
  int finest = 0;
  if (bench.levels()) {
    const auto start = Clock::now();
    finest = all->finest_level(bench.levels()->finest);
    all->levels(finest);
    const double made_s = seconds_since(start);
    const double levels_still = settled(bench, *all, finest);
    whole = bench.draw(*all, 0, options.samples, finest);
    row_of_all("levels", levels_still, whole.seconds);
    std::printf("  %.1f dB to the row above; levels from %d on, made in %.3f s\n", psnr(whole.sums, voxels.sums),
                finest, made_s);
  }
  std::fflush(stdout);
  bool same = true;
  for (const double share : {0.5, 0.25}) {
    bench.stand_at(35);
    auto some = cache_of(bench, static_cast<std::uint64_t>(share * static_cast<double>(bricks)), free);
    int some_finest = 0;
    if (finest != 0) some_finest = some->finest_level(finest);
    const double some_still = settled(bench, *some, some_finest);
    const Frame picture = bench.draw(*some, 0, options.samples, some_finest);
    if (some_finest != finest) {
      std::printf("levels from %d on\n", some_finest);
      whole = bench.draw(*all, 0, options.samples, some_finest);
      all->levels(finest);
    }
    const bool equal = picture.sums == whole.sums;
    same = same && equal;
    const Orbit turned = orbit(bench, *all, *some, some_finest, options.frames);
    std::printf("%-8.2f %9llu %9.3f %7.3f %9.3f %7.3f %7llu %8u %9.2f %7.3f %7.3f %7.3f %s\n", share,
                static_cast<unsigned long long>(some->cache().bricks()), 1e3 * some_still, still / some_still,
                picture.seconds, voxels.seconds / picture.seconds,
                static_cast<unsigned long long>(picture.report.turns), picture.report.least_tiles,
                static_cast<double>(some->cache().counters().decoded) /
                    static_cast<double>(std::max<std::uint64_t>(some->cache().counters().built, 1)),
                turned.ratio, turned.worst, turned.settled, equal ? "same" : "OTHER");
    bench.stand_at(35);
    bench.draft(true);
    const double draft_still = settled(bench, *some, some_finest);
    const Orbit draft = orbit(bench, *all, *some, some_finest, options.frames);
    bench.draft(false);
    std::printf("%-8s %9s %9.3f %7.3f %41s %7.3f %7.3f %7.3f %.4f, %.4f of pixels missed something\n", "draft", "",
                1e3 * draft_still, still / draft_still, "", draft.ratio, draft.worst, draft.settled, draft.missed,
                draft.missed_settled);
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
