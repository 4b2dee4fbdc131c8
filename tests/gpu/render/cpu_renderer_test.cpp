#include "gpu/render/cpu_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <vector>

#include "format/base/error.h"
#include "gpu/render/render_scene.h"
#include "tests/stock/test_grid.h"

namespace weir::cpu_renderer_test {
namespace {

using test::TestGrid;
using test::TestGridOptions;

constexpr std::array kModes{RenderMode::path, RenderMode::dvr, RenderMode::iso, RenderMode::mip};
constexpr std::array kFilters{Filter::nearest, Filter::trilinear, Filter::stochastic};

float ball(const Index3& i) {
  const auto x = static_cast<float>(i.x - 12);
  const auto y = static_cast<float>(i.y - 12);
  const auto z = static_cast<float>(i.z - 12);
  return greater(0.0F, 1 - std::sqrt(x * x + y * y + z * z) / 12);
}

Image picture(const NvdbGrid& grid, const Scene& scene, Filter filter = Filter::trilinear, int threads = 0,
              std::uint64_t seed = 0, std::uint32_t samples = 3) {
  RenderOptions options;
  options.width = 41;
  options.height = 35;
  options.filter = filter;
  options.seed = seed;
  const RenderScene prepared(grid, scene, options);
  CpuRenderOptions cpu;
  cpu.samples = samples;
  cpu.threads = threads;
  return render_cpu(prepared.task(), cpu);
}

void expect_finite(const Image& image) {
  for (const Float3& p : image.pixels) ASSERT_TRUE(is_finite(p.x) && is_finite(p.y) && is_finite(p.z));
}

// Returns the number of pixels that differ from the background.
int shown(const Image& image) {
  int count = 0;
  for (const Float3& p : image.pixels) count += p == image.at(0, 0) ? 0 : 1;
  return count;
}

TEST(RenderCpu, SamePictureForAnyNumberOfThreads) {
  const TestGrid grid({{0, 0, 0}, {25, 25, 25}}, ball);
  for (const RenderMode mode : kModes) {
    for (const Filter filter : kFilters) {
      Scene scene;
      scene.mode = mode;
      const Image one = picture(grid.grid(), scene, filter, 1);
      EXPECT_EQ(one.pixels, picture(grid.grid(), scene, filter, 2).pixels);
      EXPECT_EQ(one.pixels, picture(grid.grid(), scene, filter, 7).pixels);
    }
  }
}

TEST(RenderCpu, TheSeedMatters) {
  const TestGrid grid({{0, 0, 0}, {25, 25, 25}}, ball);
  EXPECT_NE(picture(grid.grid(), {}, Filter::trilinear, 0, 1).pixels,
            picture(grid.grid(), {}, Filter::trilinear, 0, 2).pixels);
}

TEST(RenderCpu, EveryModeShowsTheBall) {
  const TestGrid grid({{-4, 0, 0}, {25, 25, 25}}, ball);
  for (const RenderMode mode : kModes) {
    Scene scene;
    scene.mode = mode;
    const Image image = picture(grid.grid(), scene);
    expect_finite(image);
    EXPECT_GT(shown(image), 100) << render_mode_name(mode);
    EXPECT_NE(image.at(20, 17), image.at(0, 0)) << render_mode_name(mode);
  }
}

// Stochastic taps give the trilinear picture in expectation: compare the means of all pixels.
TEST(RenderCpu, StochasticAndTrilinearAgree) {
  const TestGrid grid({{0, 0, 0}, {25, 25, 25}}, ball);
  Scene scene;
  scene.volume.albedo = 0.9;
  // Only linear functions keep an expectation, so the opacity is linear in the value and the colour constant.
  scene.volume.opacity = {{0, 0}, {1, 1}};
  scene.volume.colormap = "white";
  const auto mean = [&](Filter filter, std::uint64_t seed) {
    double sum = 0;
    const Image image = picture(grid.grid(), scene, filter, 0, seed, 32);
    for (const Float3& p : image.pixels) sum += static_cast<double>(p.x);
    return sum / static_cast<double>(image.pixels.size());
  };
  // The spread between seeds of one filter is the measure.
  double spread = 0;
  double trilinear = 0;
  double stochastic = 0;
  std::array<double, 6> means{};
  for (std::uint64_t seed = 0; seed < means.size(); ++seed) {
    means[seed] = mean(Filter::trilinear, seed);
    trilinear += means[seed] / 6;
    stochastic += mean(Filter::stochastic, seed + 100) / 6;
  }
  for (const double m : means) spread += (m - trilinear) * (m - trilinear) / 5;
  EXPECT_NEAR(trilinear, stochastic, 5 * std::sqrt(spread * 2 / 6) + 1e-5);
}

// Surfaces and maxima are functions of the position, so a stochastic filter is trilinear for them.
TEST(RenderCpu, StochasticSurfacesAndMaxima_AreTheTrilinearOnes) {
  const TestGrid grid({{0, 0, 0}, {25, 25, 25}}, ball);
  for (const RenderMode mode : kModes) {
    Scene scene;
    scene.mode = mode;
    const bool same = picture(grid.grid(), scene, Filter::stochastic).pixels == picture(grid.grid(), scene).pixels;
    EXPECT_EQ(same, mode == RenderMode::iso || mode == RenderMode::mip) << render_mode_name(mode);
  }
}

TEST(RenderCpu, HardVolumesGiveFinitePictures) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  TestGridOptions tiles;
  tiles.tiles = {{{0, 0, 0}, 8, 1, true}, {{8, 8, 0}, 8, 2, true}};
  std::vector<TestGrid> grids;
  grids.emplace_back(Box{{0, 0, 0}, {1, 1, 1}}, [](const Index3&) { return 5.0F; });
  grids.emplace_back(Box{{0, 0, 0}, {1, 1, 300}}, [](const Index3& i) { return static_cast<float>(i.z); });
  grids.emplace_back(Box{{0, 0, 0}, {9, 9, 9}}, [](const Index3&) { return 3.0F; });
  grids.emplace_back(Box{{0, 0, 0}, {9, 9, 9}}, [&](const Index3&) { return nan; });
  grids.emplace_back(Box{{0, 0, 0}, {9, 9, 9}},
                     [&](const Index3& i) { return i.x % 3 == 0 ? nan : (i.y % 4 == 0 ? kInfinity : ball(i)); });
  grids.emplace_back(Box{{0, 0, 0}, {9, 9, 9}}, [](const Index3& i) { return i.x % 2 == 0 ? 3e38F : -3e38F; });
  grids.emplace_back(Box{{0, 0, 0}, {9, 9, 9}}, [](const Index3& i) { return static_cast<float>(i.x) * 1e-45F; });
  grids.emplace_back(Box{{0, 0, 0}, {9, 9, 9}}, [](const Index3& i) { return static_cast<float>(i.x) * 1e-16F; });
  grids.emplace_back(Box{}, ball, tiles);
  for (const TestGrid& grid : grids) {
    for (const RenderMode mode : kModes) {
      for (const Filter filter : kFilters) {
        Scene scene;
        scene.mode = mode;
        expect_finite(picture(grid.grid(), scene, filter, 0, 0, 2));
      }
    }
  }
}

TEST(RenderCpu, NotANumberRendersAsNothing) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const TestGrid grid({{0, 0, 0}, {25, 25, 25}}, [&](const Index3&) { return nan; });
  for (const RenderMode mode : kModes) {
    Scene scene;
    scene.mode = mode;
    EXPECT_EQ(shown(picture(grid.grid(), scene)), 0) << render_mode_name(mode);
  }
}

// A wall with a channel along its 2048 shortest edges: every cell contains some of the wall.
TEST(RenderCpu, ClearChannelThroughAWall_ShowsTheBackground) {
  TestGridOptions options;
  options.voxel_size = {1, 1, 64};
  const TestGrid grid(
      {{0, 0, 0}, {32, 32, 32}}, [](const Index3& i) { return i.x >= 13 && i.x < 19 ? 0.0F : 1.0F; }, options);
  Scene scene;
  scene.camera.position = {15.5, 16, -500};
  scene.camera.look_at = {15.5, 16, 0};
  scene.camera.up = {0, 1, 0};
  scene.camera.fov = 0.01;
  scene.volume.range = {0, 1};
  scene.volume.opacity = {{0, 0}, {1, 1}};
  scene.volume.density = 1e6;
  scene.volume.albedo = 0;
  scene.lighting.background = {1, 1, 1};
  RenderOptions one_pixel;
  one_pixel.width = one_pixel.height = 1;
  const RenderScene prepared(grid.grid(), scene, one_pixel);
  CpuRenderOptions cpu;
  cpu.samples = 2;
  EXPECT_EQ(render_cpu(prepared.task(), cpu).pixels[0], (Float3{1, 1, 1}));
}

TEST(RenderCpu, ProgressReachesTheTotalAndNeverPassesIt) {
  const TestGrid grid({{0, 0, 0}, {9, 9, 9}}, ball);
  RenderOptions options;
  options.width = 50;
  options.height = 40;
  const RenderScene prepared(grid.grid(), {}, options);
  CpuRenderOptions cpu;
  cpu.samples = 9;
  std::uint64_t most = 0;
  cpu.progress = [&](std::uint64_t done) { most = std::max(most, done); };
  cpu.threads = 1;
  render_cpu(prepared.task(), cpu);
  EXPECT_EQ(most, 50U * 40U * 9U);
}

TEST(RenderCpu, CancelIsInterrupted) {
  const TestGrid grid({{0, 0, 0}, {9, 9, 9}}, ball);
  const RenderScene prepared(grid.grid(), {}, {});
  std::atomic<bool> cancel{false};
  CpuRenderOptions cpu;
  cpu.samples = 1 << 20;
  cpu.cancel = &cancel;
  cpu.progress = [&](std::uint64_t) { cancel = true; };
  try {
    render_cpu(prepared.task(), cpu);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::interrupted);
    EXPECT_STREQ(error.what(), "interrupted; no image was written");
  }
}

TEST(RenderCpu, PictureThatIsGoneOnWith_IsThatOfOneCall) {
  const TestGrid grid({{0, 0, 0}, {9, 9, 9}}, ball);
  RenderOptions options;
  options.width = 50;
  options.height = 40;
  const RenderScene prepared(grid.grid(), {}, options);
  CpuRenderOptions cpu;
  cpu.samples = 9;
  cpu.threads = 1;
  const Image whole = render_cpu(prepared.task(), cpu);
  std::atomic<bool> cancel{false};
  KeptPixels kept;
  cpu.cancel = &cancel;
  cpu.kept = &kept;
  cpu.progress = [&](std::uint64_t) { cancel = true; };
  EXPECT_THROW(render_cpu(prepared.task(), cpu), Error);
  EXPECT_EQ(kept.drawn(), 16U * 4U) << "a row of a tile, after which progress is told";
  cancel = false;
  std::uint64_t most = 0;
  cpu.progress = [&](std::uint64_t done) { most = std::max(most, done); };
  const Image resumed = render_cpu(prepared.task(), cpu);
  EXPECT_EQ(most, 50U * 40U * 9U);
  EXPECT_EQ(kept.drawn(), 0U);
  for (std::size_t i = 0; i < whole.pixels.size(); ++i) {
    ASSERT_EQ(resumed.pixels[i].x, whole.pixels[i].x) << i;
    ASSERT_EQ(resumed.pixels[i].y, whole.pixels[i].y) << i;
    ASSERT_EQ(resumed.pixels[i].z, whole.pixels[i].z) << i;
  }
}

}  // namespace
}  // namespace weir::cpu_renderer_test
