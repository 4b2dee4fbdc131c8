// weir_bench_save [EDGE [DIRECTORY]]: measures saving a step of EDGE^3 float32 values, 1024 by default, as a packed
// file in DIRECTORY, /dev/shm by default, or in this process's memory. It measures values that lie on the device, with
// all of the selection, the layout and the writing; the same values in the host's memory with all cores; and a plain
// copy of the values to page-locked memory. For a cloud at rates 20 and 53, and turbulence at rate 8 and 60 dB.
// Compares files byte by byte. Exits with 1 if two files differ, 2 for any other failure.
#include <cuda_runtime_api.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/gpu/block_field.h"
#include "compressor/conversion.h"
#include "compressor/push/resident_source.h"
#include "format/base/error.h"
#include "format/base/trace.h"
#include "format/io/memory_file_system.h"
#include "gpu/cuda/encode/resident_volume.h"
#include "gpu/cuda/load/pinned_memory.h"
#include "gpu/cuda/runtime/check.h"
#include "gpu/cuda/runtime/device_array.h"
#include "ingest/synthetic/cloud.h"
#include "ingest/synthetic/turbulence.h"
#include "ingest/values/array_source.h"

namespace weir {
namespace {

constexpr int kRuns = 3;

struct Saved {
  double seconds = 0;
  Sidecar sidecar;
};

class Bench {
 public:
  Bench(std::string name, const Field& field, std::string directory)
      : name_(std::move(name)), field_(field), directory_(std::move(directory)), values_(field.values.size()) {
    values_.upload(field.values);
    array_.data = field.values.data();
    array_.extent = {field.edge, field.edge, field.edge};
    array_.stride = packed_stride(array_.extent, array_.type);
  }

  void copy_to_host() {
    std::string refusal;
    const auto pinned = PinnedMemory::make(std::min<std::size_t>(values_.bytes(), std::size_t{1} << 28U), refusal);
    if (!pinned) throw Error(ErrorKind::io, refusal);
    const std::size_t piece = std::min<std::size_t>(values_.bytes(), std::size_t{1} << 28U);
    std::vector<double> seconds;
    for (int run = 0; run < kRuns; ++run) {
      seconds.push_back(seconds_of([&] {
        for (std::size_t at = 0; at < values_.bytes(); at += piece) {
          check_cuda(
              cudaMemcpyAsync(pinned->data(), reinterpret_cast<const std::byte*>(values_.data()) + at,
                              std::min(piece, values_.bytes() - at), cudaMemcpyDeviceToHost, cudaStreamPerThread),
              "copying to the host");
        }
        check_cuda(cudaStreamSynchronize(cudaStreamPerThread), "copying to the host");
      }));
    }
    say("a plain copy to page-locked memory", *std::ranges::min_element(seconds));
  }

  bool save(const std::string& label, const Budget& budget) {
    const std::string cpu = directory_ + "/cpu.nvdb";
    const std::string device = directory_ + "/device.nvdb";
    const auto best = [&](const std::string& what, const std::string& output, const auto& files, const auto& open) {
      Saved fastest;
      for (int run = 0; run < kRuns; ++run) {
        remove_pair(output);  // a simulation, too, writes each step under a new name
        Saved saved = convert(*files(), output, budget, name_ + ", " + label, open);
        if (run == 0 || saved.seconds < fastest.seconds) fastest = std::move(saved);
      }
      say(label + ", " + what, fastest.seconds);
      const Sidecar::Timing& timing = fastest.sidecar.timing;
      std::printf("%-12s   survey %.3f s, selection, encoding and the rest %.3f s, %llu bytes, %.2f dB\n",
                  name_.c_str(), timing.survey_s, timing.encode_s,
                  static_cast<unsigned long long>(fastest.sidecar.file.bytes),
                  fastest.sidecar.error.psnr_db.value_or(0));
      return fastest;
    };
    const auto resident = [&] {
      return open_resident(make_resident_volume(0, values_.data(), array_info(array_).domain(),
                                                [](const Error& error) { throw Error(error); }),
                           array_info(array_));
    };
    const auto disk = [] { return make_posix_file_system(); };
    const auto memory = [] { return std::make_unique<MemoryFileSystem>(); };
    const Saved by_cpu = best("by all cores, from the host's memory", cpu, disk, [&] { return open_array(array_); });
    best("on the device, from its memory", device, disk, resident);
    const Saved kept = best("the same, the file in this process's memory", "kept.nvdb", memory, resident);
    const bool same = same_files(cpu, device) && kept.sidecar.file.digest == by_cpu.sidecar.file.digest;
    std::printf("%-12s %s: %s\n", name_.c_str(), label.c_str(), same ? "same bytes" : "OTHER BYTES");
    std::fflush(stdout);
    remove_pair(cpu);
    remove_pair(device);
    return same;
  }

 private:
  void say(const std::string& what, double seconds) const {
    std::printf("%-12s %-52s %9.4f s %8.1f GB/s\n", name_.c_str(), what.c_str(), seconds,
                field_.bytes() / seconds / 1e9);
    std::fflush(stdout);
  }

  template <typename Open>
  static Saved convert(FileSystem& files, const std::string& output, const Budget& budget, const std::string& label,
                       const Open& open) {
    ConversionOptions options;
    options.output = output;
    options.overwrite = true;
    options.encoding = Encoding::packed;
    options.budget = budget;
    options.resume = Resume::off;
    options.memory = std::uint64_t{12} << 30U;  // for the CPU; the bench's own values take 4.3 GB of it
    ConversionControl control;
    std::unique_ptr<Trace> trace;
    if (const char* const path = std::getenv("WEIR_BENCH_TRACE"))
      trace = std::make_unique<Trace>(path + ("/" + label) + ".json");
    control.trace = trace.get();
    Saved saved;
    saved.seconds = seconds_of([&] {
      const std::unique_ptr<VolumeSource> source = open();
      saved.sidecar = convert_volume(*source, options, control, files);
    });
    return saved;
  }

  static void remove_pair(const std::string& volume) {
    std::remove(volume.c_str());
    std::remove((volume + ".json").c_str());
  }

  static bool same_files(const std::string& a, const std::string& b) {
    return std::system(("cmp '" + a + "' '" + b + "'").c_str()) == 0;
  }

  std::string name_;
  const Field& field_;
  std::string directory_;
  DeviceArray<float> values_;
  DenseArray array_;
};

Budget rate(double rate) {
  Budget budget;
  budget.kind = Budget::Kind::rate;
  budget.rate = rate;
  return budget;
}
Budget psnr(double db) {
  Budget budget;
  budget.kind = Budget::Kind::psnr;
  budget.target = db;
  return budget;
}

}  // namespace
}  // namespace weir

int main(int argc, char** argv) {
  using namespace weir;
  try {
    const std::int64_t edge = argc > 1 ? std::strtoll(argv[1], nullptr, 10) : 1024;
    const std::string directory = argc > 2 ? argv[2] : "/dev/shm";
    if (edge < 1) throw Error(ErrorKind::usage, "usage: weir_bench_save [EDGE [DIRECTORY]]");
    use_device(0);
    cudaDeviceProp device{};
    check_cuda(cudaGetDeviceProperties(&device, 0), "asking for the device");
    std::printf("%s, %u cores\n", device.name, std::thread::hardware_concurrency());
    const SyntheticOptions options{{edge, edge, edge}, 1};
    bool same = true;
    {
      const Field field = fill(*make_cloud(options), edge);
      Bench bench("cloud", field, directory);
      bench.copy_to_host();
      same = bench.save("rate 20", rate(20)) && same;
      same = bench.save("rate 53.3", rate(53.3)) && same;
    }
    const Field field = fill(*make_turbulence(options), edge);
    Bench bench("turbulence", field, directory);
    bench.copy_to_host();
    same = bench.save("rate 8", rate(8)) && same;
    same = bench.save("60 dB", psnr(60)) && same;
    return same ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "weir_bench_save: %s\n", error.what());
    return 2;
  }
}
