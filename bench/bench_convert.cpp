// Measures the seconds of a conversion at rate 8, to float and to quantised leaves, as a multiple of two plain reading
// passes over its input in the same run. Also measures the process's peak memory against the volume's size.
//
// Environment: WEIR_BENCH_DIR (default: the system's temporary directory) and WEIR_BENCH_DIM (voxels along the timed
// cube, default 512: 0.5 GB of float32). WEIR_COMMAND, set by the build, names the `weir` command for the memory
// measurement.
#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "compressor/conversion.h"
#include "format/base/seconds_since.h"
#include "format/base/text.h"
#include "format/io/descriptor.h"
#include "ingest/source_registry.h"
#include "ingest/synthetic/synthetic.h"

namespace weir {
namespace {

std::filesystem::path bench_directory() {
  const char* directory = std::getenv("WEIR_BENCH_DIR");
  return directory != nullptr ? std::filesystem::path(directory) : std::filesystem::temp_directory_path();
}

std::int64_t bench_dim() {
  const char* dim = std::getenv("WEIR_BENCH_DIM");
  return dim != nullptr ? parse_int(dim).value_or(512) : 512;
}

/// A synthetic volume as a raw file, and a path for its conversion; both are removed at the end.
class RawVolume {
 public:
  RawVolume(const std::string& kind, std::int64_t dim) {
    path_ = bench_directory() / cat("weir_bench_", ::getpid(), '_', dim, 'x', dim, 'x', dim, "_float32.raw");
    const auto source = open_synthetic(kind, {{dim, dim, dim}, 1});
    std::ofstream file(path_, std::ios::binary);
    for (std::int64_t z = 0; z < dim; z += kLeafDim) {
      const Box slab{{0, 0, z}, {dim, dim, std::min(z + kLeafDim, dim)}};
      std::vector<float> values(static_cast<std::size_t>(slab.voxels()));
      source->read(slab, values);
      file.write(reinterpret_cast<const char*>(values.data()),
                 static_cast<std::streamsize>(values.size() * sizeof(float)));
    }
  }
  ~RawVolume() {
    remove_output();
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  RawVolume(const RawVolume&) = delete;
  RawVolume& operator=(const RawVolume&) = delete;

  void remove_output() const {
    std::error_code ignored;
    std::filesystem::remove(output(), ignored);
    std::filesystem::remove(sidecar_path(output()), ignored);
  }

  std::string path() const { return path_.string(); }
  std::string output() const { return path_.string() + ".nvdb"; }

 private:
  std::filesystem::path path_;
};

/// One single-threaded pass over a cached file into a buffer that stays warm.
void read_plainly(const std::string& path) {
  std::vector<char> buffer(std::size_t{4} << 20U);
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  while (::read(file.get(), buffer.data(), buffer.size()) > 0) benchmark::DoNotOptimize(buffer.data());
}

void convert(const std::string& kind, Encoding encoding, benchmark::State& state) {
  const RawVolume volume(kind, bench_dim());
  const auto files = make_posix_file_system();
  read_plainly(volume.path());
  double reading_s = 0;
  double converting_s = 0;
  for (auto _ : state) {
    auto start = std::chrono::steady_clock::now();
    read_plainly(volume.path());
    read_plainly(volume.path());
    reading_s += seconds_since(start);
    start = std::chrono::steady_clock::now();
    const auto source = open_source(volume.path(), {});
    ConversionOptions options;
    options.output = volume.output();
    options.encoding = encoding;
    const Sidecar sidecar = convert_volume(*source, options, {}, *files);
    const double seconds = seconds_since(start);
    converting_s += seconds;
    state.SetIterationTime(seconds);
    state.counters["psnr_db"] = sidecar.error.psnr_db.value_or(0);
    volume.remove_output();  // freeing the previous file is not part of a conversion
  }
  const auto n = static_cast<double>(state.iterations());
  state.counters["two_passes_s"] = reading_s / n;
  state.counters["ratio"] = converting_s / reading_s;
}

void convert_cloud(benchmark::State& state) { convert("cloud", Encoding::float32, state); }
BENCHMARK(convert_cloud)->UseManualTime()->Iterations(5)->Unit(benchmark::kMillisecond);

void convert_turbulence(benchmark::State& state) { convert("turbulence", Encoding::float32, state); }
BENCHMARK(convert_turbulence)->UseManualTime()->Iterations(5)->Unit(benchmark::kMillisecond);

void quantise_cloud(benchmark::State& state) { convert("cloud", Encoding::fpn, state); }
BENCHMARK(quantise_cloud)->UseManualTime()->Iterations(5)->Unit(benchmark::kMillisecond);

void quantise_turbulence(benchmark::State& state) { convert("turbulence", Encoding::fpn, state); }
BENCHMARK(quantise_turbulence)->UseManualTime()->Iterations(5)->Unit(benchmark::kMillisecond);

/// Returns the peak memory that the sidecar of the command records for its own process.
double peak_of_command(const RawVolume& volume) {
  std::vector<std::string> words{WEIR_COMMAND, "convert", volume.path(), "-o",         volume.output(),
                                 "--memory",   "256MiB",  "--log-level", "off",        "--progress",
                                 "never",      "--rate",  "8",           "--overwrite"};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  if (::posix_spawn(&child, words.front().c_str(), nullptr, nullptr, arguments.data(), environ) != 0) return 0;
  int status = 0;
  ::waitpid(child, &status, 0);
  if (status != 0) return 0;
  std::ifstream file(sidecar_path(volume.output()));
  const std::string text(std::istreambuf_iterator<char>(file), {});
  return static_cast<double>(parse_sidecar(text, volume.output()).timing.peak_rss_bytes);
}

/// Peak memory of a conversion with --memory 256MiB; the argument is the edge of the cube.
void peak_memory(benchmark::State& state) {
  const RawVolume volume("cloud", state.range(0));
  for (auto _ : state) {
    const double peak = peak_of_command(volume);
    if (peak == 0) state.SkipWithError("the conversion failed");
    state.counters["volume_MiB"] = static_cast<double>(std::filesystem::file_size(volume.path())) / 0x1p20;
    state.counters["peak_MiB"] = peak / 0x1p20;
  }
}
BENCHMARK(peak_memory)->Arg(256)->Arg(512)->Arg(832)->Arg(1290)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
}  // namespace weir

BENCHMARK_MAIN();
