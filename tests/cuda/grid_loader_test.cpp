// Tests every way of loading to the device. They run on a device in weir_tests_cuda, and on a pretended one
// (tests/fake_cuda/) everywhere.
#include "gpu/cuda/grid_loader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "gpu/cuda/runtime/check.h"
#include "tests/cuda/support/grid_file.h"
#include "tests/cuda/support/process_resources.h"
#include "tests/cuda/support/refusal.h"
#include "tests/support/sanitized.h"
#include "tests/support/temporary_directory.h"

namespace weir::grid_loader_test {
namespace {

using test::GridFileOptions;
using test::write_grid_file;

constexpr std::array kPaths{LoadPath::registered, LoadPath::pinned_ring, LoadPath::direct_storage, LoadPath::pageable};

std::vector<std::byte> downloaded(const DeviceGrid& grid) {
  std::vector<std::byte> bytes(grid.bytes());
  // cudaMemcpyDefault copies from the device or from registered host memory, according to the address.
  check_cuda(cudaMemcpy(bytes.data(), grid.data(), bytes.size(), cudaMemcpyDefault), "reading back");
  return bytes;
}

bool holds(const DeviceGrid& grid, const NvdbFile& file) {
  const auto data = file.grid().data();
  return std::ranges::equal(downloaded(grid), data);
}

std::uint64_t free_device_bytes() {
  std::size_t free = 0;
  std::size_t total = 0;
  check_cuda(cudaMemGetInfo(&free, &total), "asking for free memory");
  return free;
}

using test::mappings_of;
using test::open_descriptors;
using test::refusal;
using test::status_kib;

class GridLoader : public testing::Test {
 protected:
  void SetUp() override {
    if (device_count() == 0) GTEST_SKIP() << "no CUDA device";
  }

  std::string write(int edge, const GridFileOptions& options = {}) const {
    const std::string path = directory_ / cat("grid", edge, "_", options.grid_offset, ".nvdb");
    write_grid_file(path, edge, options);
    return path;
  }

  // Direct storage is skipped if the system does not offer it.
  static bool offered(LoadPath path) { return path != LoadPath::direct_storage || DirectStorage::offered(); }

  const TemporaryDirectory directory_;
};

TEST_F(GridLoader, EveryWayBringsTheGridWithoutItsPadding) {
  for (const GridFileOptions& layout :
       {GridFileOptions{4096, 100000}, GridFileOptions{8192, 0}, GridFileOptions{333, 77}}) {
    const NvdbFile file(write(64, layout));
    ASSERT_EQ(file.grid().grid_offset(), layout.grid_offset);
    ASSERT_EQ(file.grid().grid_bytes() - file.grid().data_bytes(), layout.tail_bytes);
    for (const LoadPath path : kPaths) {
      if (!offered(path)) continue;
      // From one chunk for the whole grid to hundreds of one page each.
      for (const std::uint64_t chunk_bytes : {1ULL << 30U, 1ULL << 20U, 70000ULL, 1ULL}) {
        SCOPED_TRACE(cat(load_path_name(path), ", chunks of ", chunk_bytes, ", grid at ", layout.grid_offset));
        DeviceBuffer buffer;
        buffer.reserve(file.grid().data_bytes() + 4096);
        check_cuda(cudaMemset(buffer.data(), 0x55, buffer.capacity()), "filling");
        const DeviceGrid grid =
            load_grid(file, std::move(buffer), {.only = path, .chunk_bytes = chunk_bytes, .threads = 3});
        EXPECT_EQ(load_path_name(grid.report().path), load_path_name(path));
        EXPECT_EQ(grid.report().note, "");
        EXPECT_FALSE(grid.report().zero_copy);
        EXPECT_GT(grid.report().gb_per_s(), 0);
        EXPECT_EQ(grid.bytes(), file.grid().data_bytes());
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(grid.data()) % 256, 0U);
        EXPECT_TRUE(holds(grid, file));
        std::array<std::byte, 4096> behind{};
        check_cuda(cudaMemcpy(behind.data(), grid.data() + grid.bytes(), behind.size(), cudaMemcpyDefault), "reading");
        EXPECT_TRUE(std::ranges::all_of(behind, [](std::byte b) { return b == std::byte{0x55}; }));
      }
    }
  }
}

TEST_F(GridLoader, TriesTheFastestWayFirst) {
  using enum LoadPath;
  EXPECT_EQ(load_paths(kSmallGrid - 1, 64), (std::vector{pageable, pinned_ring, registered}));
  EXPECT_EQ(load_paths(kSmallGrid, kThreadsForRing), (std::vector{pinned_ring, registered, pageable}));
  EXPECT_EQ(load_paths(kSmallGrid, kThreadsForRing - 1), (std::vector{registered, pinned_ring, pageable}));
  const NvdbFile file(write(40));
  const DeviceGrid grid = load_grid(file, {});
  EXPECT_EQ(load_path_name(grid.report().path), "pageable");
  EXPECT_EQ(grid.report().note, "");
  EXPECT_TRUE(holds(grid, file));
}

TEST_F(GridLoader, TellsTheStagesOfTheRegisteredPipeline) {
  const NvdbFile file(write(40));
  const DeviceGrid grid = load_grid(file, {}, {.only = LoadPath::registered});
  EXPECT_EQ(load_path_name(grid.report().path), "registered");
  EXPECT_EQ(grid.report().note, "");
  EXPECT_GT(grid.report().stages.register_s, 0);
  EXPECT_GT(grid.report().stages.unregister_s, 0);
  EXPECT_TRUE(holds(grid, file));
}

TEST_F(GridLoader, LoadsAGridOfOneVoxelOnAStream) {
  const NvdbFile file(write(1));
  cudaStream_t stream = nullptr;
  check_cuda(cudaStreamCreate(&stream), "making a stream");
  for (const LoadPath path : kPaths) {
    if (!offered(path)) continue;
    const DeviceGrid grid = load_grid(file, {}, {.only = path}, stream);
    EXPECT_TRUE(holds(grid, file)) << load_path_name(path);
  }
  check_cuda(cudaStreamDestroy(stream), "destroying a stream");
}

TEST_F(GridLoader, ReusesABufferThatIsLargeEnough) {
  const NvdbFile small(write(16));
  const NvdbFile large(write(40));
  DeviceGrid grid = load_grid(large, {});
  const std::byte* const at = grid.data();
  DeviceBuffer buffer = std::move(grid).take_buffer();
  EXPECT_EQ(buffer.capacity(), large.grid().data_bytes());
  for (const NvdbFile* file : {&small, &large, &small}) {
    for (const LoadPath path : kPaths) {
      if (!offered(path)) continue;
      DeviceGrid again = load_grid(*file, std::move(buffer), {.only = path});
      EXPECT_EQ(again.data(), at);
      EXPECT_TRUE(holds(again, *file));
      buffer = std::move(again).take_buffer();
    }
  }
  DeviceBuffer little;
  little.reserve(1);
  EXPECT_TRUE(holds(load_grid(large, std::move(little)), large));
}

TEST_F(GridLoader, ZeroCopyLeavesTheGridInHostMemory) {
  for (const GridFileOptions& layout :
       {GridFileOptions{4096, 5000}, GridFileOptions{4096 + 32, 0}, GridFileOptions{333, 77}}) {
    const NvdbFile file(write(64, layout));
    const bool aligned = layout.grid_offset % 32 == 0;
    DeviceGrid grid = load_grid(file, {}, {.chunk_bytes = 100000, .zero_copy = true});
    EXPECT_TRUE(grid.report().zero_copy);
    EXPECT_EQ(load_path_name(grid.report().path), aligned ? "registered" : "pinned-ring");
    EXPECT_EQ(grid.report().note, aligned ? "" : "not registered: the grid is at byte 333, no multiple of 32");
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(grid.data()) % 32, 0U);
    EXPECT_TRUE(holds(grid, file));
    DeviceBuffer buffer = std::move(grid).take_buffer();
    EXPECT_EQ(buffer.capacity(), 0U);
    // The pages are unlocked, because they can be locked again.
    EXPECT_TRUE(holds(load_grid(file, std::move(buffer), {.only = LoadPath::registered}), file));
    EXPECT_TRUE(holds(load_grid(file, {}, {.only = LoadPath::pinned_ring, .zero_copy = true}), file));
  }
}

TEST_F(GridLoader, ZeroCopyHasTwoWaysOnly) {
  const NvdbFile file(write(1));
  EXPECT_EQ(
      refusal(ErrorKind::io, [&] { load_grid(file, {}, {.only = LoadPath::pageable, .zero_copy = true}); }),
      file.path() + ": cannot be brought to the device: not pageable: a grid does not stay in host memory that way");
}

TEST_F(GridLoader, SaysWhichFileWasTruncatedWithoutASignal) {
  for (const LoadPath path : kPaths) {
    if (!offered(path)) continue;
    for (const bool zero_copy : {false, true}) {
      if (zero_copy && path != LoadPath::registered && path != LoadPath::pinned_ring) continue;
      const std::string name = write(40);
      const NvdbFile file(name);
      const std::uint64_t bytes = file.bytes().size();
      std::filesystem::resize_file(name, 20000);
      DeviceBuffer buffer;
      EXPECT_EQ(refusal(ErrorKind::input,
                        [&] { load_grid(file, std::move(buffer), {.only = path, .zero_copy = zero_copy}); }),
                cat(name, ": had ", bytes, " bytes when it was opened, has 20000 now; open it again when it is whole"));
      // No error sticks: the same buffer takes a whole file.
      const NvdbFile whole(write(16));
      EXPECT_TRUE(holds(load_grid(whole, std::move(buffer), {.only = path}), whole));
    }
  }
}

TEST_F(GridLoader, StopsWhenItIsCancelled) {
  const NvdbFile file(write(16));
  const std::atomic<bool> cancel{true};
  for (const bool zero_copy : {false, true}) {
    EXPECT_EQ(
        refusal(ErrorKind::interrupted, [&] { load_grid(file, {}, {.zero_copy = zero_copy, .cancel = &cancel}); }),
        "interrupted while loading " + file.path());
  }
}

TEST_F(GridLoader, LeavesNothingBehindAfterAThousandLoads) {
  const std::string name = write(16);
  const auto cycle = [&](int n) {
    const NvdbFile file(name);
    const LoadPath path = kPaths[static_cast<std::size_t>(n) % kPaths.size()];
    const bool zero_copy = n % 5 == 4;
    if (zero_copy) {
      load_grid(file, {}, {.zero_copy = true});
    } else if (path != LoadPath::direct_storage) {  // cuFile keeps resources as it likes
      load_grid(file, {}, {.only = path, .chunk_bytes = 65536});
    }
  };
  for (int n = 0; n < 100; ++n) cycle(n);
  const std::uint64_t device = free_device_bytes();
  const auto descriptors = open_descriptors();
  const std::uint64_t locked = status_kib("VmLck") + status_kib("VmPin");
  const std::uint64_t resident = status_kib("VmRSS");
  for (int n = 0; n < 1000; ++n) cycle(n);
  EXPECT_EQ(free_device_bytes(), device);
  EXPECT_EQ(open_descriptors(), descriptors);
  EXPECT_EQ(mappings_of(name), 0);
  EXPECT_EQ(status_kib("VmLck") + status_kib("VmPin"), locked);
  if (!kSanitized) {
    EXPECT_LT(status_kib("VmRSS"), resident + 4096);
  }
}

}  // namespace
}  // namespace weir::grid_loader_test
