// Measures how much of a simulation's time a push takes: the seconds of PushedVolume::slab() as a multiple of a plain
// copy of as many bytes in the same run, from and to memory that is not in a cache, while the background thread works.
// `ratio` is by wall time, `cpu_ratio` by the thread's own time, for a machine that is shared. Also measures the bytes
// a second that push and end take if the simulation does nothing else.
//
// Environment: WEIR_BENCH_DIR (default: the system's temporary directory) and WEIR_BENCH_DIM (voxels along the cube,
// default 512: 0.5 GB of float32).
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "compressor/push/pushed_volume.h"
#include "format/base/seconds_since.h"
#include "format/base/text.h"
#include "ingest/synthetic/synthetic.h"

namespace weir {
namespace {

using Clock = std::chrono::steady_clock;

/// Planes handed over at a time.
constexpr std::int64_t kPlanes = 8;
/// The least size of the plain copies' target: more than a cache holds.
constexpr std::size_t kCopyBytes = std::size_t{128} << 20U;

std::string output_path() {
  const char* directory = std::getenv("WEIR_BENCH_DIR");
  const std::filesystem::path path = directory != nullptr ? directory : std::filesystem::temp_directory_path();
  return path / cat("weir_bench_push_", ::getpid(), ".nvdb");
}

std::int64_t bench_dim() {
  const char* dim = std::getenv("WEIR_BENCH_DIM");
  return dim != nullptr ? parse_int(dim).value_or(512) : 512;
}

/// A simulation: its volume, handed over in slabs.
struct Simulation {
  explicit Simulation(const std::string& kind) : dim(bench_dim()), values(static_cast<std::size_t>(dim * dim * dim)) {
    open_synthetic(kind, {{dim, dim, dim}, 1})->read({{0, 0, 0}, {dim, dim, dim}}, values);
  }
  std::int64_t slabs() const { return dim / kPlanes; }
  std::size_t slab_values() const { return static_cast<std::size_t>(dim * dim * kPlanes); }
  std::span<const float> slab(std::int64_t i) const {
    return std::span(values).subspan(static_cast<std::size_t>(i) * slab_values(), slab_values());
  }
  std::int64_t dim;
  std::vector<float> values;
};

/// Wall seconds, including waits, and seconds of this thread's own work.
struct Spent {
  double wall_s = 0;
  double cpu_s = 0;

  template <typename Work>
  void time(const Work& work) {
    const Clock::time_point start = Clock::now();
    const double before_s = cpu_now_s();
    work();
    cpu_s += cpu_now_s() - before_s;
    wall_s += seconds_since(start);
  }

 private:
  static double cpu_now_s() {
    timespec now{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
  }
};

void compute_for(double seconds) {
  const Clock::time_point start = Clock::now();
  double work = 1;
  while (seconds_since(start) < seconds) {
    for (int i = 0; i < 1000; ++i) work = work * 1.0000001 + 1e-9;
    benchmark::DoNotOptimize(work);
  }
}

/// `pause_s_per_gb`: the seconds that the simulation computes for each gigabyte that it hands over.
void push(const std::string& kind, Encoding encoding, double pause_s_per_gb, benchmark::State& state) {
  const Simulation simulation(kind);
  const auto files = make_posix_file_system();
  std::vector<std::byte> copies(std::max(kCopyBytes, simulation.slab_values() * sizeof(float)), std::byte{1});
  Spent slabs;
  Spent copying;
  Spent ends;
  for (auto _ : state) {
    SourceInfo info;
    info.path = kind;
    info.extent = {simulation.dim, simulation.dim, simulation.dim};
    ConversionOptions options;
    options.output = output_path();
    options.encoding = encoding;
    PushedVolume pushed(info, options, {}, *files);
    const double before_s = slabs.wall_s;
    for (std::int64_t i = 0; i < simulation.slabs(); ++i) {
      const std::span<const float> slab = simulation.slab(i);
      slabs.time([&] { pushed.slab(i * kPlanes, kPlanes, slab.data()); });
      // Copies as many bytes from a distant place.
      const auto other = std::as_bytes(simulation.slab((i + simulation.slabs() / 2) % simulation.slabs()));
      const std::size_t at = static_cast<std::size_t>(i) * other.size() % (copies.size() - other.size() + 1);
      copying.time([&] { std::memcpy(&copies[at], other.data(), other.size()); });
      benchmark::DoNotOptimize(copies.data());
      compute_for(static_cast<double>(slab.size_bytes()) / 1e9 * pause_s_per_gb);
    }
    state.SetIterationTime(slabs.wall_s - before_s);
    ends.time([&] { pushed.end(); });
    std::filesystem::remove(options.output);
    std::filesystem::remove(sidecar_path(options.output));
  }
  const auto n = static_cast<double>(state.iterations());
  const double gb = static_cast<double>(std::as_bytes(std::span(simulation.values)).size()) / 1e9;
  state.counters["slab_GB_per_s"] = gb * n / slabs.wall_s;
  state.counters["copy_GB_per_s"] = gb * n / copying.wall_s;
  state.counters["ratio"] = slabs.wall_s / copying.wall_s;
  state.counters["cpu_ratio"] = slabs.cpu_s / copying.cpu_s;
  state.counters["end_s"] = ends.wall_s / n;
}

/// The simulation takes two seconds for a gigabyte; the background thread is then faster than the simulation.
constexpr double kComputes = 2;

void push_cloud(benchmark::State& state) { push("cloud", Encoding::float32, kComputes, state); }
BENCHMARK(push_cloud)->UseManualTime()->Iterations(3)->Unit(benchmark::kMillisecond);

void push_turbulence(benchmark::State& state) { push("turbulence", Encoding::float32, kComputes, state); }
BENCHMARK(push_turbulence)->UseManualTime()->Iterations(3)->Unit(benchmark::kMillisecond);

void push_turbulence_quantised(benchmark::State& state) { push("turbulence", Encoding::fpn, kComputes, state); }
BENCHMARK(push_turbulence_quantised)->UseManualTime()->Iterations(3)->Unit(benchmark::kMillisecond);

/// Only pushes: each slab waits for the background thread.
void push_turbulence_only(benchmark::State& state) { push("turbulence", Encoding::float32, 0, state); }
BENCHMARK(push_turbulence_only)->UseManualTime()->Iterations(3)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace weir

BENCHMARK_MAIN();
