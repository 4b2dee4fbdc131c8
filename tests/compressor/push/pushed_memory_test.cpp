// The memory that a push takes, as the kernel reports it. It stays below the ceiling for a volume eight times as large,
// with planes in random order.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "compressor/push/pushed_volume.h"
#include "format/process/process_memory.h"
#include "tests/support/child_answer.h"
#include "tests/support/sanitized.h"
#include "tests/support/temporary_directory.h"

namespace weir::pushed_memory_test {
namespace {

constexpr std::uint64_t kMemory = std::uint64_t{64} << 20U;
constexpr Index3 kExtent{512, 512, 512};

// Fills a plane with values that are cheap to make; no leaf is constant.
void simulate(std::int64_t z, std::vector<float>& plane) {
  auto hash = static_cast<std::uint32_t>(z + 1) * 2654435761U;
  for (float& v : plane) {
    hash = hash * 1664525U + 1013904223U;
    v = static_cast<float>(hash >> 8U);
  }
}

// Runs in a child process, so that its peak memory is its own. Returns the text that the child prints on the pipe.
std::string measure(const std::string& output) {
  std::vector<std::int64_t> planes(static_cast<std::size_t>(kExtent.z));
  std::iota(planes.begin(), planes.end(), 0);
  std::shuffle(planes.begin(), planes.end(), std::mt19937(1));
  std::vector<std::vector<float>> current(2, std::vector<float>(static_cast<std::size_t>(kExtent.x * kExtent.y), 1.0F));
  const std::uint64_t before = resident_bytes();
  ConversionOptions options;
  options.output = output;
  options.memory = kMemory;
  options.threads = 2;
  SourceInfo info;
  info.path = "density";
  info.extent = kExtent;
  const auto files = make_posix_file_system();
  PushedVolume pushed(info, options, {}, *files);
  {
    std::vector<std::jthread> threads;
    for (std::size_t t = 0; t < current.size(); ++t) {
      threads.emplace_back([&, t] {
        for (std::size_t i = t; i < planes.size(); i += current.size()) {
          simulate(planes[i], current[t]);
          pushed.slab(planes[i], 1, current[t].data());
        }
      });
    }
  }
  const Sidecar sidecar = pushed.end();
  if (sidecar.file.bytes != static_cast<std::uint64_t>(volume(kExtent)) * sizeof(float) / 8)
    return "not the size asked";
  const std::uint64_t taken = peak_resident_bytes() - before;
  if (taken >= kMemory) return "takes " + std::to_string(taken) + " bytes";
  if (sidecar.error.lossless || sidecar.selection.leaves_kept < 10000) return "not what was pushed";
  return "ok " + std::to_string(taken >> 20U);
}

TEST(PushedMemory, StaysUnderTheCeilingWithPlanesInRandomOrder) {
  if (kSanitized) GTEST_SKIP() << kSanitizedSkip;
  const TemporaryDirectory directory;
  const std::string answer = answer_of_child([&] { return measure(directory / "out.nvdb"); });
  EXPECT_TRUE(answer.starts_with("ok")) << answer;
  RecordProperty("taken", answer);
}

}  // namespace
}  // namespace weir::pushed_memory_test
