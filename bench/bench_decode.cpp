// How fast one core decodes packed blocks: all streams of synthetic volumes converted to rates,
// in GB of float32 values a second, of which blocks without a stream count none; beside it the same values copied.
//
// Environment: WEIR_BENCH_DIM (voxels along the cube, default 256).
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "compressor/conversion.h"
#include "format/base/text.h"
#include "format/nanovdb/nvdb_file.h"
#include "ingest/synthetic/synthetic.h"

namespace weir {
namespace {

/// The packed volume as a mapped file; its name is gone at once, the mapping stays.
NvdbFile packed_volume(const std::string& kind, double rate) {
  const char* text = std::getenv("WEIR_BENCH_DIM");
  const std::int64_t dim = text != nullptr ? parse_int(text).value_or(256) : 256;
  const std::string path =
      (std::filesystem::temp_directory_path() / cat("weir_bench_decode_", ::getpid(), ".nvdb")).string();
  const auto source = open_synthetic(kind, {{dim, dim, dim}, 1});
  ConversionOptions options;
  options.output = path;
  options.encoding = Encoding::packed;
  options.budget = {.kind = Budget::Kind::rate, .rate = rate};
  const auto files = make_posix_file_system();
  convert_volume(*source, options, {}, *files);
  NvdbFile file(path);
  std::filesystem::remove(path);
  std::filesystem::remove(sidecar_path(path));
  return file;
}

std::vector<PackedStream> streams_of(const PackedData& packed, std::uint64_t& bytes) {
  std::vector<PackedStream> streams;
  const NodeLattice& regions = packed.regions();
  for (std::int64_t r = 0; r < regions.size(); ++r) {
    const PackedRegion region = packed.region(regions.position(r));
    if (region.chunk == 0) continue;
    packed.for_each_stream(region, [&](unsigned, const PackedStream& stream) {
      if (stream.data == nullptr) return;
      streams.push_back(stream);
      bytes += stream.bytes;
    });
  }
  return streams;
}

void decode(benchmark::State& state, const std::string& kind) {
  const NvdbFile file = packed_volume(kind, static_cast<double>(state.range(0)));
  const PackedData& packed = *file.grid().packed();
  std::uint64_t bytes = 0;
  const std::vector<PackedStream> streams = streams_of(packed, bytes);
  std::array<float, 512> values;
  for (auto _ : state) {
    for (const PackedStream& stream : streams) {
      packed.decode(stream, values);
      benchmark::DoNotOptimize(values.data());
    }
  }
  const double voxels = 512.0 * static_cast<double>(streams.size());
  state.SetBytesProcessed(static_cast<std::int64_t>(4 * voxels) * state.iterations());
  state.counters["bits_a_voxel"] = 8.0 * static_cast<double>(bytes) / voxels;
}

BENCHMARK_CAPTURE(decode, turbulence, "turbulence")->Arg(16)->Arg(8)->Arg(4)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(decode, cloud, "cloud")->Arg(50)->Arg(20)->Arg(8)->Unit(benchmark::kMillisecond);

/// Block by block, from memory to a core's cache.
void copy(benchmark::State& state) {
  const std::vector<float> all(std::size_t{1} << 24U, 1.0F);
  std::array<float, 512> values;
  for (auto _ : state) {
    for (std::size_t i = 0; i < all.size(); i += values.size()) {
      std::memcpy(values.data(), all.data() + i, sizeof values);
      benchmark::DoNotOptimize(values.data());
    }
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(4 * all.size()) * state.iterations());
}

BENCHMARK(copy)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace weir

BENCHMARK_MAIN();
