// Measures the rate of the block stream over a raw file, cold and cached, as a ratio of the plainest possible
// sequential read of the same file in the same run: O_DIRECT preads for the cold file, preads into a warm buffer for
// the cached file.
//
// Environment: WEIR_BENCH_DIR (default: the system's temporary directory; must be on the disk to measure) and
// WEIR_BENCH_MIB (default 1024).
#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "format/base/text.h"
#include "format/io/descriptor.h"
#include "ingest/plan/block_plan.h"
#include "ingest/plan/block_stream.h"
#include "ingest/plan/page_buffer.h"
#include "ingest/raw/raw_source.h"

namespace weir {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;
constexpr std::size_t kPlainBytes = 4 * kMiB;  ///< per read of the plain loops

/// A file of float32 noise, 1024 x 256 voxels a plane, removed at the end.
class NoiseFile {
 public:
  NoiseFile() {
    const char* directory = std::getenv("WEIR_BENCH_DIR");
    const char* mib = std::getenv("WEIR_BENCH_MIB");
    extent_ = {1024, 256, mib != nullptr ? parse_int(mib).value_or(1024) : 1024};
    path_ = (directory != nullptr ? std::filesystem::path(directory) : std::filesystem::temp_directory_path()) /
            cat("weir_bench_", ::getpid(), '_', extent_.x, 'x', extent_.y, 'x', extent_.z, "_float32.raw");
    const Descriptor file(::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600));
    std::vector<std::uint32_t> plane(kMiB / sizeof(std::uint32_t));
    std::uint32_t state = 1;
    for (std::uint32_t& value : plane) value = 0x3f800000U | ((state = state * 1664525U + 1013904223U) >> 9U);
    for (std::int64_t z = 0; z < extent_.z; ++z) {
      if (::write(file.get(), plane.data(), kMiB) != static_cast<ssize_t>(kMiB)) std::abort();
    }
    ::fsync(file.get());
  }
  ~NoiseFile() { ::unlink(path_.c_str()); }
  NoiseFile(const NoiseFile&) = delete;
  NoiseFile& operator=(const NoiseFile&) = delete;

  const std::string& path() const { return path_; }
  std::uint64_t bytes() const { return static_cast<std::uint64_t>(volume(extent_)) * sizeof(float); }
  void drop() const {
    const Descriptor file(::open(path_.c_str(), O_RDONLY | O_CLOEXEC));
    ::posix_fadvise(file.get(), 0, 0, POSIX_FADV_DONTNEED);
  }

 private:
  Index3 extent_;
  std::string path_;
};

const NoiseFile& noise_file() {
  static const NoiseFile file;
  return file;
}

double seconds_of(const auto& action) {
  const auto start = std::chrono::steady_clock::now();
  action();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Returns the bytes read; 0 if the file system refuses `flags`.
std::uint64_t read_plainly(int flags) {
  const Descriptor file(::open(noise_file().path().c_str(), O_RDONLY | O_CLOEXEC | flags));
  const PageBuffer buffer(kPlainBytes);
  std::uint64_t bytes = 0;
  while (true) {
    const ssize_t count = ::read(file.get(), buffer.bytes().data(), kPlainBytes);
    if (count <= 0) return bytes;
    bytes += static_cast<std::uint64_t>(count);
    benchmark::ClobberMemory();
  }
}

void read_stream(DirectIo mode) {
  SourceOptions options;
  options.direct_io = mode;
  const auto source = open_raw(noise_file().path(), options);
  const BlockPlan plan = plan_blocks(source->info().domain(), source->access(), 64 * kMiB);
  std::vector<Box> boxes;
  for (std::int64_t i = 0; i < plan.size(); ++i) boxes.push_back(plan.voxel_box(plan.leaf_box(i)));
  stream_blocks(*source, boxes, {}, [](const Block& block) { benchmark::DoNotOptimize(block.values.data()); });
}

/// Each iteration measures the plain read and the stream, one after the other, so that a disk with a drifting rate
/// slows both.
void compare(benchmark::State& state, bool cold, DirectIo mode) {
  double plain_s = 0;
  double stream_s = 0;
  if ((cold || mode == DirectIo::on) && read_plainly(O_DIRECT) != noise_file().bytes()) {
    state.SkipWithError("the file system refuses direct reads; name a directory on a disk by WEIR_BENCH_DIR");
    return;
  }
  if (!cold) read_plainly(0);
  for (auto _ : state) {
    if (cold) noise_file().drop();
    plain_s += seconds_of([&] { read_plainly(cold ? O_DIRECT : 0); });
    if (cold) noise_file().drop();
    const double s = seconds_of([&] { read_stream(mode); });
    stream_s += s;
    state.SetIterationTime(s);
  }
  const double gigabytes = static_cast<double>(noise_file().bytes()) * static_cast<double>(state.iterations()) / 1e9;
  state.counters["plain_GB/s"] = gigabytes / plain_s;
  state.counters["stream_GB/s"] = gigabytes / stream_s;
  state.counters["ratio"] = plain_s / stream_s;
}

BENCHMARK_CAPTURE(compare, cold_auto, true, DirectIo::automatic)
    ->UseManualTime()
    ->Iterations(3)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(compare, cold_buffered, true, DirectIo::off)
    ->UseManualTime()
    ->Iterations(3)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(compare, cached_auto, false, DirectIo::automatic)
    ->UseManualTime()
    ->Iterations(3)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(compare, cached_direct, false, DirectIo::on)
    ->UseManualTime()
    ->Iterations(3)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace weir

BENCHMARK_MAIN();
