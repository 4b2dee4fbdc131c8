// A thousand loads of packed grids and a thousand evictions of bricks on a device leave device memory, page-locked
// memory, descriptors and mappings as they were.
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gpu/cuda/render/cuda_backend.h"
#include "tests/cuda/support/device_reads.h"
#include "tests/cuda/support/packed_ball.h"
#include "tests/cuda/support/process_resources.h"
#include "tests/support/temporary_directory.h"

namespace weir::paging_leak_test {
namespace {

constexpr std::size_t kOther = std::size_t{1} << 20U;  // bytes that a driver may round up by

struct Held {
  std::uint64_t pool = test::pool_bytes();
  std::size_t device = test::used_device_bytes();
  std::uint64_t locked = test::status_kib("VmLck") + test::status_kib("VmPin");
  std::ptrdiff_t descriptors = test::open_descriptors();
};

void expect_as_before(const Held& before, const std::string& path) {
  const Held after;
  EXPECT_EQ(after.pool, before.pool);
  EXPECT_LE(after.device, before.device + kOther);
  EXPECT_EQ(after.locked, before.locked);
  EXPECT_EQ(after.descriptors, before.descriptors);
  EXPECT_EQ(test::mappings_of(path), 0);
}

class PagingLeaks : public testing::Test {
 protected:
  void SetUp() override { WEIR_NEEDS_DEVICE(); }

  // The medium is so thin that rays meet bricks everywhere in it.
  static Picture picture(Backend& backend, LoadedVolume& volume, double azimuth, bool draft = false) {
    Scene scene;
    scene.mode = RenderMode::dvr;
    scene.volume.density = 0.5;
    scene.camera.azimuth = azimuth;
    RenderOptions options;
    options.width = 64;
    options.height = 64;
    SampleOptions sampling;
    sampling.draft = draft;
    return backend.render(volume, scene, options, sampling);
  }

  TemporaryDirectory directory_;
  const std::string path_ = directory_ / "grid.nvdb";
};

TEST_F(PagingLeaks, AThousandEvictionsOfOneCache_LeaveNothing) {
  CudaOptions options;
  options.memory = test::kSmallCache;
  const auto backend = make_cuda_backend(options);
  const auto orbit = [&](std::uint64_t least) {
    const auto volume = backend->load(test::written(path_, test::packed_ball(240).file), 16, nullptr);
    picture(*backend, *volume, 0);
    const std::uint64_t pool = test::pool_bytes();
    std::uint64_t evicted = 0;
    int pictures = 0;
    for (; evicted < least && pictures < 100; ++pictures) {
      evicted += picture(*backend, *volume, 37.0 * pictures, pictures % 4 == 3).cache.evicted;
    }
    EXPECT_GE(evicted, least) << "in " << pictures << " pictures";
    EXPECT_EQ(test::pool_bytes(), pool) << "paging allocates nothing that stays";
  };
  orbit(1);
  const Held before;
  orbit(10000);
  expect_as_before(before, path_);
}

TEST_F(PagingLeaks, AThousandLoadsOfAPackedGrid_LeaveNothing) {
  test::written(path_, test::packed_ball(24).file);
  std::vector<std::unique_ptr<Backend>> backends;
  for (const LoadPath path : {LoadPath::pageable, LoadPath::pinned_ring, LoadPath::registered}) {
    for (const bool in_host_memory : {false, true}) {
      if (in_host_memory && path == LoadPath::pageable) continue;
      CudaOptions options;
      options.load.only = path;
      options.load.zero_copy = in_host_memory;
      backends.push_back(make_cuda_backend(options));
    }
  }
  const auto cycle = [&](std::size_t n) {
    Backend& backend = *backends[n % backends.size()];
    auto volume = backend.load(std::make_shared<const NvdbFile>(path_), 16, nullptr);
    if (n % 2 == 0) volume = backend.load(std::make_shared<const NvdbFile>(path_), 16, std::move(volume));
    if (n % 10 == 0) picture(backend, *volume, 0);
  };
  for (std::size_t n = 0; n < 50; ++n) cycle(n);
  const Held before;
  for (std::size_t n = 0; n < 1000; ++n) cycle(n);
  expect_as_before(before, path_);
}

}  // namespace
}  // namespace weir::paging_leak_test
