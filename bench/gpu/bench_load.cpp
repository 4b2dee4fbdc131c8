// weir_bench_load FILE.nvdb: measures how fast each way brings a file from the page cache to the device, against the
// rate of copies from page-locked memory, which no way can exceed. Exits with 1 unless the median of the loader's own
// choice reaches 0.8 of the median of that rate; 2 for any other failure.
#include <cuda_runtime_api.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/descriptor.h"
#include "format/nanovdb/nvdb_file.h"
#include "gpu/cuda/grid_loader.h"
#include "gpu/cuda/load/pinned_memory.h"
#include "gpu/cuda/runtime/check.h"
#include "gpu/cuda/runtime/device_array.h"

namespace weir {
namespace {

constexpr double kLeastRatio = 0.8;
constexpr int kRuns = 5;
constexpr std::uint64_t kMiB = 1ULL << 20U;

/// The runs of one way, the fastest first.
struct Timing {
  std::vector<LoadReport> runs;

  double best_s() const { return runs.front().seconds; }
  double median_s() const { return runs[runs.size() / 2].seconds; }
};

Timing timed(const std::function<LoadReport()>& load) {
  load();
  Timing timing;
  for (int run = 0; run < kRuns; ++run) timing.runs.push_back(load());
  std::ranges::sort(timing.runs, {}, &LoadReport::seconds);
  return timing;
}

/// Runs `work` and returns its seconds as a report on `bytes`.
LoadReport clocked(std::uint64_t bytes, const std::function<void()>& work) {
  LoadReport report;
  report.bytes = bytes;
  const auto begin = std::chrono::steady_clock::now();
  work();
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return report;
}

class Table {
 public:
  explicit Table(std::uint64_t bytes, double limit_s) : bytes_(bytes), limit_s_(limit_s) {
    std::printf("%-38s %8s %8s %7s %6s  %8s %8s %8s %8s %8s\n", "way", "best s", "median s", "GB/s", "ratio",
                "populate", "register", "wait", "drain", "unlock");
  }

  /// Prints a way. GB/s and the ratio to the limit are of the median run; stages are of the fastest run, in seconds,
  /// summed over threads.
  void row(const std::string& way, const Timing& timing) const {
    const LoadStages& stages = timing.runs.front().stages;
    std::printf("%-38s %8.4f %8.4f %7.2f %6.3f  %8.4f %8.4f %8.4f %8.4f %8.4f\n", way.c_str(), timing.best_s(),
                timing.median_s(), static_cast<double>(bytes_) / timing.median_s() / 1e9, ratio(timing),
                stages.populate_s, stages.register_s, stages.copy_wait_s, stages.drain_s, stages.unregister_s);
    std::fflush(stdout);
  }
  void no_row(const std::string& way, const std::string& reason) const {
    std::printf("%-38s %s\n", way.c_str(), reason.c_str());
  }
  double ratio(const Timing& timing) const { return limit_s_ / timing.median_s(); }

 private:
  std::uint64_t bytes_;
  double limit_s_;
};

/// Copies `bytes` from 1 GiB of page-locked memory, which is reused.
Timing pinned_limit(std::uint64_t bytes, std::byte* device) {
  const std::uint64_t piece = std::min(bytes, 1024 * kMiB);
  std::string refusal;
  const auto memory = PinnedMemory::make(piece, refusal);
  if (!memory) throw Error(ErrorKind::io, refusal);
  std::fill_n(memory->data(), piece, std::byte{1});
  return timed([&] {
    return clocked(bytes, [&] {
      for (std::uint64_t at = 0; at < bytes; at += piece) {
        check_cuda(cudaMemcpyAsync(device + at, memory->data(), std::min(piece, bytes - at), cudaMemcpyHostToDevice),
                   "copying to the device");
      }
      check_cuda(cudaDeviceSynchronize(), "copying to the device");
    });
  });
}

/// Loads as readGrid and an upload do: the file into ordinary memory, then that memory to the device.
Timing stock_way(const std::string& path, std::uint64_t bytes, std::byte* device) {
  return timed([&] {
    return clocked(bytes, [&] {
      const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
      const auto memory = std::make_unique_for_overwrite<std::byte[]>(bytes);
      for (std::uint64_t at = 0; at < bytes;) {
        const ssize_t got = ::read(file.get(), memory.get() + at, bytes - at);
        if (got <= 0) throw Error(ErrorKind::input, path + ": cannot be read");
        at += static_cast<std::uint64_t>(got);
      }
      check_cuda(cudaMemcpy(device, memory.get(), bytes, cudaMemcpyHostToDevice), "copying to the device");
    });
  });
}

/// Loads the file into one buffer, and maps it anew each time as for a series.
class Loads {
 public:
  explicit Loads(std::string path) : path_(std::move(path)) {}

  Timing time(const LoadOptions& options) {
    return timed([&] {
      const NvdbFile file(path_);
      DeviceGrid grid = load_grid(file, std::move(buffer_), options);
      LoadReport report = grid.report();
      buffer_ = std::move(grid).take_buffer();
      return report;
    });
  }

 private:
  std::string path_;
  DeviceBuffer buffer_;
};

void print_machine() {
  cudaDeviceProp properties{};
  check_cuda(cudaGetDeviceProperties(&properties, 0), "asking for the device's properties");
  int driver = 0;
  check_cuda(cudaDriverGetVersion(&driver), "asking for the driver's version");
  std::printf(
      "%s, CUDA driver %d.%d; registers read-only memory: %d, pageable memory access: %d, by host page tables: %d\n",
      properties.name, driver / 1000, driver % 1000 / 10, properties.hostRegisterReadOnlySupported,
      properties.pageableMemoryAccess, properties.pageableMemoryAccessUsesHostPageTables);
}

int run(const std::string& path) {
  use_device(0);
  print_machine();
  std::uint64_t bytes = 0;
  const LoadReport open = clocked(0, [&] { bytes = NvdbFile(path).grid().data_bytes(); });
  std::printf("%s: grid of %s; opening and closing it took %.4f s\n", path.c_str(), format_bytes(bytes).c_str(),
              open.seconds);

  DeviceArray<std::byte> device(bytes);
  const Timing limit = pinned_limit(bytes, device.data());
  const Table table(bytes, limit.median_s());
  table.row("limit: copy from page-locked memory", limit);
  table.row("stock way: read, then pageable copy", stock_way(path, bytes, device.data()));
  device = {};

  Loads loads(path);
  const Timing by_itself = loads.time({});
  const LoadReport& taken = by_itself.runs.front();
  table.row(cat("by default: ", load_path_name(taken.path)), by_itself);
  if (!taken.note.empty()) std::printf("  %s\n", taken.note.c_str());
  for (const LoadPath only :
       {LoadPath::registered, LoadPath::pinned_ring, LoadPath::direct_storage, LoadPath::pageable}) {
    const std::string way = cat("only ", load_path_name(only));
    try {
      table.row(way, loads.time({.only = only}));
    } catch (const Error& error) {
      table.no_row(way, error.what());
    }
  }
  for (const int threads : {1, 2, 3, 4}) {
    for (const std::uint64_t chunk : {32, 64, 128, 256}) {
      table.row(cat("registered, ", chunk, " MiB, ", threads, " threads"),
                loads.time({.only = LoadPath::registered, .chunk_bytes = chunk * kMiB, .threads = threads}));
    }
  }
  table.row("zero copy, set-up", loads.time({.zero_copy = true}));
  table.row("zero copy, set-up, 4 threads", loads.time({.threads = 4, .zero_copy = true}));

  const double ratio = table.ratio(by_itself);
  const bool good = ratio >= kLeastRatio;
  std::printf("%s: by default %s at %.3f of the limit; it must be %.1f or more\n", good ? "passed" : "FAILED",
              std::string(load_path_name(taken.path)).c_str(), ratio, kLeastRatio);
  return good ? 0 : 1;
}

}  // namespace
}  // namespace weir

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: weir_bench_load FILE.nvdb\n");
    return 2;
  }
  try {
    return weir::run(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "weir_bench_load: %s\n", error.what());
    return 2;
  }
}
