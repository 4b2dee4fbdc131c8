// Packed grids, and grids larger than the device memory they are given, on a device. The pictures agree with the
// CPU's, and pictures from a cache are bit for bit those of all bricks.
#include "gpu/cuda/render/brick_volume.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <regex>

#include "format/base/error.h"
#include "gpu/cuda/render/cuda_backend.h"
#include "tests/cuda/support/device_reads.h"
#include "tests/cuda/support/packed_ball.h"
#include "tests/cuda/support/process_resources.h"
#include "tests/stock/test_grid.h"
#include "tests/support/temporary_directory.h"

namespace weir::brick_volume_test {
namespace {

constexpr std::array kModes{RenderMode::path, RenderMode::dvr, RenderMode::iso, RenderMode::mip};
constexpr std::array kFilters{Filter::nearest, Filter::trilinear, Filter::stochastic};
constexpr std::uint64_t kSmall = test::kSmallCache;
constexpr std::uint64_t kSmallWithLevels = test::kSmallCacheWithLevels;

class BrickVolumeTest : public testing::Test {
 protected:
  void SetUp() override { WEIR_NEEDS_DEVICE(); }

  std::shared_ptr<const NvdbFile> file(std::span<const std::byte> bytes) {
    return test::written(directory_ / "grid.nvdb", bytes);
  }

  std::shared_ptr<const NvdbFile> ball(float odd = 0.5F) { return file(test::packed_ball(200, odd).file); }

  static Image picture(Backend& backend, const LoadedVolume& volume, RenderMode mode, Filter filter,
                       std::uint32_t samples = 3, const std::optional<LevelOfDetail>& levels = std::nullopt) {
    Scene scene;
    scene.mode = mode;
    scene.volume.density = 20;
    RenderOptions options;
    options.width = 80;
    options.height = 60;
    options.filter = filter;
    options.levels = levels;
    return backend.render(const_cast<LoadedVolume&>(volume), scene, options, {samples, nullptr, {}}).image;
  }

  static std::unique_ptr<Backend> cuda(std::optional<std::uint64_t> memory = std::nullopt, bool levels = false) {
    CudaOptions options;
    options.memory = memory;
    options.levels = levels;
    return make_cuda_backend(options);
  }

  TemporaryDirectory directory_;
};

int differing(const Image& a, const Image& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) count += a.pixels[i] == b.pixels[i] ? 0 : 1;
  return count;
}

// Returns the largest difference of any channel, without the 2 % of the pixels that differ most.
float difference(const Image& a, const Image& b) {
  std::vector<float> differences;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const Float3 d = a.pixels[i] - b.pixels[i];
    differences.push_back(greater(std::abs(d.x), greater(std::abs(d.y), std::abs(d.z))));
  }
  std::sort(differences.begin(), differences.end());
  return differences[differences.size() * 98 / 100];
}

TEST_F(BrickVolumeTest, StepAfterALargerOne_TakesWhatItTakesAlone) {
  const auto large = test::written(directory_ / "large.nvdb", test::packed_ball(200, 0.5F).file);
  const auto small = test::written(directory_ / "small.nvdb", test::packed_ball(60, 0.5F).file);
  const auto backend = cuda();
  std::unique_ptr<LoadedVolume> volume = backend->load(small, 0, nullptr);
  const std::uint64_t alone = test::pool_bytes();
  volume = backend->load(large, 0, std::move(volume));
  EXPECT_GT(test::pool_bytes(), alone);
  volume = backend->load(small, 0, std::move(volume));
  EXPECT_EQ(test::pool_bytes(), alone);
}

TEST_F(BrickVolumeTest, MarchedPicturesOfAPackedGridAreTheCpus) {
  const auto grid = ball();
  const auto device = cuda();
  const auto host = make_cpu_backend(0);
  const auto on_device = device->load(grid, 16, nullptr);
  const auto on_host = host->load(grid, 16, nullptr);
  const std::regex note("all of 1[0-9]+ bricks, .* MiB, 16-bit texels, off by at most [0-9.]+e-06");
  EXPECT_TRUE(std::regex_match(on_device->load_summary().note, note)) << on_device->load_summary().note;
  for (const RenderMode mode : {RenderMode::dvr, RenderMode::iso, RenderMode::mip}) {
    for (const Filter filter : {Filter::nearest, Filter::trilinear}) {
      EXPECT_LT(difference(picture(*device, *on_device, mode, filter), picture(*host, *on_host, mode, filter)), 0.02F)
          << render_mode_name(mode) << ' ' << static_cast<int>(filter);
    }
  }
}

TEST_F(BrickVolumeTest, ASmallCacheDrawsTheBitsOfAllBricks) {
  const auto grid = ball();
  const auto large = cuda();
  const auto small = cuda(kSmall);
  const auto all = large->load(grid, 16, nullptr);
  const auto some = small->load(grid, 16, nullptr);
  EXPECT_NE(some->load_summary().note.find("a cache of "), std::string::npos) << some->load_summary().note;
  for (const RenderMode mode : kModes) {
    for (const Filter filter : kFilters) {
      EXPECT_EQ(picture(*small, *some, mode, filter).pixels, picture(*large, *all, mode, filter).pixels)
          << render_mode_name(mode) << ' ' << static_cast<int>(filter);
    }
  }
}

TEST_F(BrickVolumeTest, LevelsOfDetailAreTheCpus) {
  test::TestGridOptions stock;
  stock.type = GridType::fp16;
  const test::TestGrid made(
      {{-7, 0, 3}, {150, 170, 140}},
      [](const Index3& i) { return 0.5F + 0.4F * std::sin(0.1F * static_cast<float>(i.x + 2 * i.y - i.z)); }, stock);
  const test::TestGrid layers({{-7, 0, 3}, {150, 170, 140}}, [](const Index3& i) {
    return (i.z & 32) != 0 ? 0.5F : std::numeric_limits<float>::quiet_NaN();
  });
  const auto device = cuda(std::nullopt, true);
  const auto host = make_cpu_backend(0, {.levels = true});
  for (const char* name : {"packed", "fp16", "layers between NaN"}) {
    const std::string what = name;
    const auto grid = what == "packed" ? ball() : file(what == "fp16" ? made.file() : layers.file());
    const auto on_device = device->load(grid, 16, nullptr);
    const auto on_host = host->load(grid, 16, nullptr);
    for (const RenderMode mode : {RenderMode::dvr, RenderMode::iso, RenderMode::mip}) {
      for (const float bias : {0.0F, 1.5F}) {
        const LevelOfDetail levels{bias, 0};
        const Image found = picture(*device, *on_device, mode, Filter::trilinear, 3, levels);
        EXPECT_LT(difference(found, picture(*host, *on_host, mode, Filter::trilinear, 3, levels)), 0.02F)
            << what << ' ' << render_mode_name(mode) << ' ' << bias;
        if (what == "layers between NaN") continue;  // a surface may be the same
        EXPECT_NE(found.pixels, picture(*device, *on_device, mode, Filter::trilinear).pixels);
      }
    }
  }
}

TEST_F(BrickVolumeTest, ASmallCacheDrawsTheBitsOfAllBricksWithLevelsOfDetail) {
  const auto grid = ball();
  const auto large = cuda(std::nullopt, true);
  const auto small = cuda(kSmallWithLevels, true);
  const auto all = large->load(grid, 16, nullptr);
  const auto some = small->load(grid, 16, nullptr);
  EXPECT_NE(some->load_summary().note.find("a cache of "), std::string::npos) << some->load_summary().note;
  for (const RenderMode mode : kModes) {
    for (const Filter filter : kFilters) {
      // Near voxels are looked up, far ones are not. Scattered light sees coarser levels than the camera.
      for (const LevelOfDetail& levels : {LevelOfDetail{-1.2F, 0}, LevelOfDetail{-1.2F, 2}}) {
        const Image found = picture(*small, *some, mode, filter, 3, levels);
        const Image expected = picture(*large, *all, mode, filter, 3, levels);
        EXPECT_EQ(differing(found, expected), 0) << render_mode_name(mode) << ' ' << static_cast<int>(filter);
      }
    }
  }
}

// Missing bricks are there for the next draft. When all bricks are there, a draft equals the picture.
TEST_F(BrickVolumeTest, DraftsBecomeThePicture) {
  const auto grid = ball();
  for (const bool levels : {false, true}) {
    const auto large = cuda(std::nullopt, levels);
    const auto small = cuda(levels ? kSmallWithLevels : kSmall, levels);
    const auto all = large->load(grid, 16, nullptr);
    const auto some = small->load(grid, 16, nullptr);
    Scene scene;
    scene.mode = RenderMode::dvr;
    RenderOptions options;
    options.width = 80;
    options.height = 60;
    if (levels) options.levels = LevelOfDetail{-1.2F, 0};
    SampleOptions sampling;
    const Picture exact = large->render(*all, scene, options, sampling);
    EXPECT_EQ(exact.missed, 0U);
    EXPECT_EQ(exact.finest_level, levels ? 1 : 0);
    sampling.draft = true;
    Picture draft = small->render(*some, scene, options, sampling);
    EXPECT_GT(draft.missed, 20U) << levels;
    EXPECT_EQ(draft.finest_level, exact.finest_level);
    EXPECT_LT(difference(draft.image, exact.image), 0.6F) << "something is there at once";
    for (int i = 0; i < 20 && draft.missed > 0; ++i) draft = small->render(*some, scene, options, sampling);
    EXPECT_EQ(draft.missed, 0U);
    EXPECT_EQ(differing(draft.image, exact.image), 0) << levels;
  }
}

TEST_F(BrickVolumeTest, AStockGridLargerThanItsShareIsReadFromHostMemory) {
  const auto wave = [](const Index3& i) {
    return 0.5F + 0.4F * std::sin(0.3F * static_cast<float>(i.x)) * std::cos(0.2F * static_cast<float>(i.y + i.z));
  };
  for (const GridType type : {GridType::float32, GridType::fp16}) {
    test::TestGridOptions options;
    options.type = type;
    const test::TestGrid made({{0, 0, 0}, {300, 300, 270}}, wave, options);
    const auto grid = file(made.grid().bytes());
    const auto large = cuda();
    const auto small = cuda(kSmall);
    const auto all = large->load(grid, 16, nullptr);
    const auto some = small->load(grid, 16, nullptr);
    EXPECT_NE(some->load_summary().way.find("zero-copy"), std::string::npos);
    EXPECT_NE(some->load_summary().note.find("more than --device-memory 50.0 MiB, so it stays in host memory"),
              std::string::npos)
        << some->load_summary().note;
    EXPECT_EQ(picture(*small, *some, RenderMode::path, Filter::trilinear).pixels,
              picture(*large, *all, RenderMode::path, Filter::trilinear).pixels)
        << grid_type_name(type);
  }
}

TEST_F(BrickVolumeTest, ValuesThat16BitsDoNotHoldMakeFloatTexels) {
  const auto grid = ball(std::numeric_limits<float>::infinity());
  const auto large = cuda();
  const auto small = cuda(kSmall + (60U << 20U));
  const auto all = large->load(grid, 16, nullptr);
  const auto some = small->load(grid, 16, nullptr);
  EXPECT_NE(all->load_summary().note.find("float texels"), std::string::npos) << all->load_summary().note;
  for (const RenderMode mode : {RenderMode::path, RenderMode::mip}) {
    EXPECT_EQ(picture(*small, *some, mode, Filter::trilinear).pixels,
              picture(*large, *all, mode, Filter::trilinear).pixels);
  }
}

TEST_F(BrickVolumeTest, TooLittleMemoryNamesWhatWouldDo) {
  const auto grid = ball();
  try {
    cuda(1U << 20U)->load(grid, 16, nullptr);
    FAIL();
  } catch (const Error& error) {
    const std::regex words(
        "--device-memory 1.0 MiB is too small for this grid; give --device-memory ([0-9]+)MiB or more");
    std::cmatch match;
    ASSERT_TRUE(std::regex_match(error.what(), match, words)) << error.what();
    const std::uint64_t enough = std::stoull(match[1]) << 20U;
    const auto backend = cuda(enough);
    EXPECT_GT(picture(*backend, *backend->load(grid, 16, nullptr), RenderMode::dvr, Filter::trilinear, 1).pixels.size(),
              0U);
  }
}

}  // namespace
}  // namespace weir::brick_volume_test
