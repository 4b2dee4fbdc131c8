#include "tests/compressor/support/pushed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <random>
#include <string>
#include <thread>

#include "tests/compressor/support/crash_file_system.h"

namespace weir::test {

std::vector<Slab> slabs_in_order(std::int64_t planes, std::int64_t height) {
  std::vector<Slab> slabs;
  for (std::int64_t z = 0; z < planes; z += height) slabs.push_back({z, std::min(height, planes - z)});
  return slabs;
}

std::vector<Slab> shuffled_slabs(std::int64_t planes, std::int64_t highest, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<std::int64_t> height(1, highest);
  std::vector<Slab> slabs;
  for (std::int64_t z = 0; z < planes; z += slabs.back().nz) slabs.push_back({z, std::min(height(random), planes - z)});
  std::ranges::shuffle(slabs, random);
  return slabs;
}

Converted push(const SourceInfo& info, std::span<const std::byte> values, ConversionOptions options,
               const std::vector<Slab>& slabs, std::size_t threads) {
  CrashFileSystem files;
  options.output = "out.nvdb";
  if (options.memory == ConversionOptions{}.memory) options.memory = std::uint64_t{4} << 30U;
  if (options.threads == 0) options.threads = 2;
  Converted pushed;
  ConversionControl control;
  control.notice = [&](const Message& line) { pushed.notices.push_back(line.text()); };
  PushedVolume volume(info, options, control, files, threads);
  const std::size_t plane = values.size() / static_cast<std::size_t>(info.extent.z);
  std::atomic<std::size_t> next{0};
  const auto simulate = [&] {
    for (std::size_t i = next++; i < slabs.size(); i = next++) {
      const auto [z0, nz] = slabs[i];
      const auto part = values.subspan(static_cast<std::size_t>(z0) * plane, static_cast<std::size_t>(nz) * plane);
      std::vector<std::byte> slab(part.begin(), part.end());
      volume.slab(z0, nz, slab.data());
      std::ranges::fill(slab, std::byte{0x55});
    }
  };
  {
    std::vector<std::jthread> others;
    for (std::size_t i = 1; i < threads; ++i) others.emplace_back(simulate);
    simulate();
  }
  pushed.sidecar = volume.end();
  EXPECT_EQ(files.names(), (std::vector<std::string>{"out.nvdb", "out.nvdb.json"}));
  pushed.file = files.take("out.nvdb");
  return pushed;
}

void expect_same(const Converted& pushed, const Converted& expected) {
  EXPECT_TRUE(pushed.file == expected.file);
  EXPECT_EQ(pushed.notices, expected.notices);
  Sidecar ours = pushed.sidecar;
  Sidecar theirs = expected.sidecar;
  EXPECT_EQ(ours.source.format, "pushed");
  theirs.source.format = "pushed";
  theirs.source.bytes = ours.source.bytes;
  ours.timing = {};
  theirs.timing = {};
  EXPECT_EQ(to_json_text(ours), to_json_text(theirs));
}

}  // namespace weir::test
