#include "compressor/forecast/read_probe.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <vector>

#include "format/base/seconds_since.h"

namespace weir {
namespace {

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
}

// Returns the CPU time of this process so far, in seconds.
double cpu_seconds() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
}

}  // namespace

ReadCost probe_reading(VolumeSource& source, const BlockPlan& plan) {
  constexpr std::uint64_t kMostBytes = std::uint64_t{64} << 20U;
  constexpr std::int64_t kMostBlocks = 8;
  const auto fit = static_cast<std::int64_t>(kMostBytes / std::max<std::uint64_t>(1, plan.block_bytes));
  const std::int64_t blocks = std::clamp<std::int64_t>(fit, 1, std::min(kMostBlocks, plan.size()));
  std::vector<float> values(plan.block_bytes / sizeof(float));
  const std::uint64_t bytes_before = source.bytes_read();
  const double cpu_before = cpu_seconds();
  const auto started = std::chrono::steady_clock::now();
  double voxels = 0;
  for (std::int64_t i = 0; i < blocks; ++i) {
    const Box box = plan.voxel_box(plan.leaf_box((2 * i + 1) * plan.size() / (2 * blocks)));
    source.read(box, std::span(values).first(static_cast<std::size_t>(box.voxels())));
    voxels += static_cast<double>(box.voxels());
  }
  return {seconds_since(started) / voxels, (cpu_seconds() - cpu_before) / voxels,
          static_cast<double>(source.bytes_read() - bytes_before) / voxels};
}

}  // namespace weir
