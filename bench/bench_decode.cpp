// Measures how fast one core decodes packed blocks: all streams of synthetic volumes, by rate, in float32 values a
// second; blocks without a stream do not count. For comparison, measures how fast such values are copied.
//
// Environment: WEIR_BENCH_DIM (voxels along the cube, default 256).
#include <benchmark/benchmark.h>

#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "bench/converted_sample.h"
#include "format/nanovdb/nvdb_file.h"

namespace weir {
namespace {

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
  const NvdbFile file = converted_sample(kind, Encoding::packed, static_cast<double>(state.range(0)));
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

/// Copies block by block, from memory to a core's cache.
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
