// Measures the rate of reading HDF5, as ratios within one run: chunks that weir inflates and unshuffles over libhdf5's
// own H5Dread, contiguous values over the same values as a raw file, and chunks of one plane over cubes. The files are
// in the page cache: this measures the decoder, not the disk.
//
// Environment: WEIR_BENCH_DIR (default: the system's temporary directory) and WEIR_BENCH_MIB (default 256: float32
// bytes of the volume).
#include <benchmark/benchmark.h>
#include <hdf5.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "format/base/text.h"
#include "ingest/plan/block_plan.h"
#include "ingest/plan/block_stream.h"
#include "ingest/source_registry.h"

namespace weir {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;
constexpr hsize_t kWidth = 512;
constexpr hsize_t kCube = 64;
constexpr std::uint64_t kBlockBytes = 64 * kMiB;

enum class Layout { raw, contiguous, cubes, planes };

/// One volume, 512 x 512 voxels a plane, in four files that are removed at the end.
class Files {
 public:
  Files() {
    const char* directory = std::getenv("WEIR_BENCH_DIR");
    const char* mib = std::getenv("WEIR_BENCH_MIB");
    depth_ = static_cast<hsize_t>(mib != nullptr ? parse_int(mib).value_or(256) : 256) / kCube * kCube;
    directory_ = (directory != nullptr ? std::filesystem::path(directory) : std::filesystem::temp_directory_path()) /
                 cat("weir_bench_", ::getpid());
    std::filesystem::create_directories(directory_);
    write_raw();
    write_hdf5(Layout::contiguous);
    write_hdf5(Layout::cubes);
    write_hdf5(Layout::planes);
  }
  ~Files() {
    std::error_code ignored;
    std::filesystem::remove_all(directory_, ignored);
  }
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;

  hsize_t depth() const { return depth_; }
  std::uint64_t bytes() const { return kWidth * kWidth * depth_ * sizeof(float); }
  std::string path(Layout layout) const {
    switch (layout) {
      case Layout::raw:
        return directory_ / cat("volume_", kWidth, 'x', kWidth, 'x', depth_, "_float32.raw");
      case Layout::contiguous:
        return directory_ / "contiguous.h5";
      case Layout::cubes:
        return directory_ / "cubes.h5";
      case Layout::planes:
        return directory_ / "planes.h5";
    }
    return {};
  }

 private:
  /// Returns a plane of a smooth field in steps of 1/4096, with noise in the last four bits: after a shuffle, deflate
  /// reduces it to about a quarter.
  std::vector<float> plane(hsize_t z) const {
    std::vector<float> values(kWidth * kWidth);
    auto state = static_cast<std::uint32_t>(z);
    for (hsize_t y = 0; y < kWidth; ++y) {
      for (hsize_t x = 0; x < kWidth; ++x) {
        state = state * 1664525U + 1013904223U;
        const auto phase = static_cast<double>(x) * 0.013 + static_cast<double>(y) * 0.017;
        const double smooth = std::sin(phase) * std::cos(static_cast<double>(z) * 0.021);
        values[y * kWidth + x] =
            static_cast<float>(std::round(smooth * 4096) + static_cast<double>(state >> 28U)) / 4096;
      }
    }
    return values;
  }

  void write_raw() const {
    std::ofstream file(path(Layout::raw), std::ios::binary);
    for (hsize_t z = 0; z < depth_; ++z) {
      const std::vector<float> values = plane(z);
      file.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size() * 4));
    }
  }

  void write_hdf5(Layout layout) const {
    const hid_t file = H5Fcreate(path(layout).c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hsize_t extent[3] = {depth_, kWidth, kWidth};
    const hsize_t thick = layout == Layout::cubes ? kCube : 1;
    const hsize_t wide = layout == Layout::cubes ? kCube : kWidth;
    const hsize_t chunk[3] = {thick, wide, wide};
    const hid_t space = H5Screate_simple(3, extent, nullptr);
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    if (layout != Layout::contiguous) {
      H5Pset_chunk(creation, 3, chunk);
      H5Pset_shuffle(creation);
      H5Pset_deflate(creation, 4);
    }
    const hid_t dataset = H5Dcreate2(file, "density", H5T_IEEE_F32LE, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    std::vector<float> slab(thick * kWidth * kWidth);
    for (hsize_t z = 0; z < depth_; z += thick) {
      for (hsize_t i = 0; i < thick; ++i) {
        std::ranges::copy(plane(z + i), slab.begin() + static_cast<std::ptrdiff_t>(i * kWidth * kWidth));
      }
      transfer(dataset, z, thick, [&](hid_t memory, hid_t selected) {
        return H5Dwrite(dataset, H5T_NATIVE_FLOAT, memory, selected, H5P_DEFAULT, slab.data());
      });
    }
    H5Dclose(dataset);
    H5Pclose(creation);
    H5Sclose(space);
    H5Fclose(file);
  }

 public:
  /// Calls `call` with the spaces of `thick` planes from `z` on, in memory and in the file.
  static void transfer(hid_t dataset, hsize_t z, hsize_t thick, const auto& call) {
    const hsize_t start[3] = {z, 0, 0};
    const hsize_t count[3] = {thick, kWidth, kWidth};
    const hid_t memory = H5Screate_simple(3, count, nullptr);
    const hid_t selected = H5Dget_space(dataset);
    H5Sselect_hyperslab(selected, H5S_SELECT_SET, start, nullptr, count, nullptr);
    if (call(memory, selected) < 0) std::abort();
    H5Sclose(selected);
    H5Sclose(memory);
  }

 private:
  hsize_t depth_ = 0;
  std::filesystem::path directory_;
};

const Files& files() {
  static const Files all;
  return all;
}

double seconds_of(const auto& action) {
  const auto start = std::chrono::steady_clock::now();
  action();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The plain loop: slabs as thick as a chunk, so that the library, too, decodes every chunk once.
void read_by_library(Layout layout) {
  const hid_t file = H5Fopen(files().path(layout).c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t dataset = H5Dopen2(file, "density", H5P_DEFAULT);
  const hsize_t thick = layout == Layout::cubes ? kCube : 1;
  std::vector<float> slab(thick * kWidth * kWidth);
  for (hsize_t z = 0; z < files().depth(); z += thick) {
    Files::transfer(dataset, z, thick, [&](hid_t memory, hid_t selected) {
      return H5Dread(dataset, H5T_NATIVE_FLOAT, memory, selected, H5P_DEFAULT, slab.data());
    });
    benchmark::DoNotOptimize(slab.data());
  }
  H5Dclose(dataset);
  H5Fclose(file);
}

void read_stream(Layout layout) {
  const auto source = open_source(files().path(layout), {});
  const BlockPlan plan = plan_blocks(source->info().domain(), source->access(), kBlockBytes);
  std::vector<Box> boxes;
  for (std::int64_t i = 0; i < plan.size(); ++i) boxes.push_back(plan.voxel_box(plan.leaf_box(i)));
  stream_blocks(*source, boxes, {}, [](const Block& block) { benchmark::DoNotOptimize(block.values.data()); });
}

/// Each iteration measures both, one after the other, so that a machine with a drifting rate slows both.
void compare(benchmark::State& state, const auto& one, const auto& other) {
  double one_s = 0;
  double other_s = 0;
  one();
  other();
  for (auto _ : state) {
    one_s += seconds_of(one);
    const double s = seconds_of(other);
    other_s += s;
    state.SetIterationTime(s);
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(files().bytes()) * state.iterations());
  state.counters["ratio"] = one_s / other_s;
}

/// `ratio`: how many times as fast as H5Dread; at least 1.7 on two cores.
void BM_GzipCubesOverLibrary(benchmark::State& state) {
  compare(
      state, [] { read_by_library(Layout::cubes); }, [] { read_stream(Layout::cubes); });
}
void BM_GzipPlanesOverLibrary(benchmark::State& state) {
  compare(
      state, [] { read_by_library(Layout::planes); }, [] { read_stream(Layout::planes); });
}
/// `ratio`: time of the raw file over time of the HDF5 file; at least 1 / 1.2 = 0.83.
void BM_ContiguousOverRaw(benchmark::State& state) {
  compare(
      state, [] { read_stream(Layout::raw); }, [] { read_stream(Layout::contiguous); });
}
/// `ratio`: time of cubes over time of planes; at least 1 / 1.5 = 0.67.
void BM_PlanesOverCubes(benchmark::State& state) {
  compare(
      state, [] { read_stream(Layout::cubes); }, [] { read_stream(Layout::planes); });
}

BENCHMARK(BM_GzipCubesOverLibrary)->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(5);
BENCHMARK(BM_GzipPlanesOverLibrary)->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(5);
BENCHMARK(BM_ContiguousOverRaw)->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(20);
BENCHMARK(BM_PlanesOverCubes)->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(5);

}  // namespace
}  // namespace weir

BENCHMARK_MAIN();
