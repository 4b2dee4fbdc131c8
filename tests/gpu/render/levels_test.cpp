// Pictures with levels of detail, drawn by the CPU back end.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "gpu/render/backend.h"
#include "tests/stock/test_grid.h"
#include "tests/support/packed_sample.h"
#include "tests/support/temporary_directory.h"

namespace weir::levels_test {
namespace {

constexpr std::array kModes{RenderMode::path, RenderMode::dvr, RenderMode::iso, RenderMode::mip};

class LevelsOfDetail : public testing::Test {
 protected:
  std::shared_ptr<const NvdbFile> file(std::span<const std::byte> bytes) const {
    std::ofstream(path_, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return std::make_shared<const NvdbFile>(path_);
  }
  // A smooth ball of 96^3 voxels.
  std::shared_ptr<const NvdbFile> ball() const {
    const test::TestGrid made({{0, 0, 0}, {96, 96, 96}}, [](const Index3& i) {
      const auto square = [](std::int64_t at) {
        return (static_cast<float>(at) - 47.5F) * (static_cast<float>(at) - 47.5F);
      };
      return std::exp(-(square(i.x) + square(i.y) + square(i.z)) / 900);
    });
    return file(made.file());
  }

  static Scene scene_of(RenderMode mode) {
    Scene scene;
    scene.mode = mode;
    scene.volume.range = {0, 1};
    scene.volume.iso = 0.4;
    return scene;
  }
  static Picture picture(Backend& backend, LoadedVolume& volume, const Scene& scene,
                         const std::optional<LevelOfDetail>& levels, std::uint32_t samples = 16,
                         std::uint64_t seed = 0) {
    RenderOptions options;
    options.width = 40;
    options.height = 30;
    options.seed = seed;
    options.levels = levels;
    return backend.render(volume, scene, options, {samples, nullptr, {}});
  }

  TemporaryDirectory directory_;
  std::string path_ = directory_ / "a.nvdb";
};

// Returns the root mean square of the differences of all channels.
float difference(const Image& a, const Image& b) {
  float sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const Float3 d = a.pixels[i] - b.pixels[i];
    sum += dot(d, d);
  }
  return std::sqrt(sum / static_cast<float>(3 * a.pixels.size()));
}

TEST_F(LevelsOfDetail, PixelsWiderThanVoxels_SeeMeansThatLookAlike) {
  const auto backend = make_cpu_backend(2, {.levels = true});
  const auto volume = backend->load(ball(), 0, nullptr);
  for (const RenderMode mode : kModes) {
    const Picture voxels = picture(*backend, *volume, scene_of(mode), std::nullopt, 64);
    const Picture means = picture(*backend, *volume, scene_of(mode), LevelOfDetail{}, 64);
    EXPECT_EQ(voxels.finest_level, 0);
    EXPECT_EQ(means.finest_level, 1) << render_mode_name(mode);
    EXPECT_NE(means.image.pixels, voxels.image.pixels) << render_mode_name(mode);
    EXPECT_LT(difference(means.image, voxels.image), 0.03F) << render_mode_name(mode);
    // Three levels coarser, the picture differs but shows the same ball.
    const float coarse =
        difference(picture(*backend, *volume, scene_of(mode), LevelOfDetail{3, 0}, 64).image, voxels.image);
    EXPECT_GT(coarse, difference(means.image, voxels.image)) << render_mode_name(mode);
    EXPECT_LT(coarse, 0.25F) << render_mode_name(mode);
  }
}

TEST_F(LevelsOfDetail, PixelsNarrowerThanVoxels_SeeVoxels) {
  const auto backend = make_cpu_backend(2, {.levels = true});
  const auto volume = backend->load(ball(), 0, nullptr);
  for (const RenderMode mode : kModes) {
    Scene scene = scene_of(mode);
    scene.camera.zoom = 8;
    const Picture near = picture(*backend, *volume, scene, LevelOfDetail{});
    EXPECT_EQ(near.finest_level, 0);
    EXPECT_EQ(near.image.pixels, picture(*backend, *volume, scene, std::nullopt).image.pixels);
    // A bias adds to the level of the pixel's width.
    EXPECT_GE(picture(*backend, *volume, scene, LevelOfDetail{6, 0}).finest_level, 1);
  }
}

// Steps as long as a coarse level's cubes would pass through a thin volume between two samples.
TEST_F(LevelsOfDetail, ThinVolumes_AreAsOpaqueAsTheirVoxels) {
  const auto backend = make_cpu_backend(2, {.levels = true});
  for (const std::int64_t thickness : {1, 2, 5}) {
    const test::TestGrid made({{0, 0, 0}, {256, 256, thickness}}, [](const Index3&) { return 1.0F; });
    const auto volume = backend->load(file(made.file()), 0, nullptr);
    for (const RenderMode mode : {RenderMode::dvr, RenderMode::mip}) {
      Scene scene = scene_of(mode);
      scene.volume.opacity = {{0, 1}, {1, 1}};
      scene.camera.elevation = 80;
      const Picture voxels = picture(*backend, *volume, scene, std::nullopt);
      const Picture means = picture(*backend, *volume, scene, LevelOfDetail{3, 0});
      EXPECT_GE(means.finest_level, 1);
      const std::size_t centre = means.image.pixels.size() / 2 + 20;
      const Float3 seen = means.image.pixels[centre];
      const Float3 expected = voxels.image.pixels[centre];
      EXPECT_GT(length(expected), 0.1F);
      EXPECT_LT(length(seen - expected), 0.02F * length(expected)) << thickness << ' ' << render_mode_name(mode);
    }
  }
}

// A pixel is about ten voxels wide, and a layer may look half a pixel wider at each side.
TEST_F(LevelsOfDetail, LayersBesideNaN_AreSeenAsTheirVoxelsAre) {
  const auto backend = make_cpu_backend(2, {.levels = true});
  for (const auto& [thickness, widest] : {std::pair{8, 2.25F}, std::pair{32, 1.3F}}) {
    const test::TestGrid made({{0, 0, 0}, {256, 256, 256}}, [end = 128 + thickness](const Index3& i) {
      return i.z >= 128 && i.z < end ? 1.0F : std::numeric_limits<float>::quiet_NaN();
    });
    const auto volume = backend->load(file(made.file()), 0, nullptr);
    for (const RenderMode mode : {RenderMode::dvr, RenderMode::mip}) {
      Scene scene = scene_of(mode);
      scene.volume.opacity = {{0, 1}, {1, 1}};
      scene.camera.elevation = 5;
      const Picture voxels = picture(*backend, *volume, scene, std::nullopt);
      const Picture means = picture(*backend, *volume, scene, LevelOfDetail{0, 0});
      EXPECT_GE(means.finest_level, 1);
      const auto sum = [](const Image& image) {
        float all = 0;
        for (const Float3& pixel : image.pixels) all += pixel.x + pixel.y + pixel.z;
        return all;
      };
      EXPECT_GT(sum(voxels.image), 1.0F);
      EXPECT_GT(sum(means.image), 0.95F * sum(voxels.image)) << thickness << ' ' << render_mode_name(mode);
      EXPECT_LT(sum(means.image), widest * sum(voxels.image)) << thickness << ' ' << render_mode_name(mode);
    }
  }
}

// Cells bound what levels reach: a picture does not depend on their size, and nothing behind their borders is lost.
TEST_F(LevelsOfDetail, HardEdges_LookTheSameWithAnyMacrocells) {
  const test::TestGrid made({{0, 0, 0}, {96, 96, 96}}, [](const Index3& i) {
    const auto square = [](std::int64_t at) { return (at - 48) * (at - 48); };
    return square(i.x) + square(i.y) + square(i.z) < 31 * 31 ? 1.0F : 0.0F;
  });
  const auto grid = file(made.file());
  const auto backend = make_cpu_backend(2, {.levels = true});
  const auto small = backend->load(grid, 16, nullptr);
  const auto large = backend->load(grid, 512, nullptr);
  const auto mean = [](const Image& image) {
    float sum = 0;
    for (const Float3& p : image.pixels) sum += p.x + p.y + p.z;
    return sum / static_cast<float>(image.pixels.size());
  };
  for (const LevelOfDetail& levels : {LevelOfDetail{0, 3}, LevelOfDetail{1, 0}, LevelOfDetail{3, 0}}) {
    for (const RenderMode mode : kModes) {
      // If cubes are a third of the ball wide, the steps along a ray are visible.
      if (levels.bias > 1 && (mode == RenderMode::iso || mode == RenderMode::mip)) continue;
      Scene scene = scene_of(mode);
      scene.lighting.background = Double3{0, 0, 0};
      scene.camera.framing = Framing::volume;
      const Image of_small = picture(*backend, *small, scene, levels, 64).image;
      const Image of_large = picture(*backend, *large, scene, levels, 64).image;
      EXPECT_GT(mean(of_small), 0);
      EXPECT_NEAR(mean(of_small) / mean(of_large), 1, mode == RenderMode::path ? 0.05 : 0.02)
          << render_mode_name(mode) << ' ' << levels.bias << ' ' << levels.scattered;
    }
  }
}

TEST_F(LevelsOfDetail, Surface_IsFoundWhereCellsOfVoxelsDoNotHoldIt) {
  // The means of a slab cross the iso value in cells that contain only zeros.
  const test::TestGrid made({{0, 0, 0}, {96, 96, 96}},
                            [](const Index3& i) { return i.x >= 17 && i.x < 79 ? 1.0F : 0.0F; });
  const auto backend = make_cpu_backend(2, {.levels = true});
  const auto volume = backend->load(file(made.file()), 16, nullptr);
  const auto hits = [&](const std::optional<LevelOfDetail>& levels) {
    Scene scene = scene_of(RenderMode::iso);
    scene.camera.azimuth = 0;
    const Image image = picture(*backend, *volume, scene, levels, 1).image;
    return std::ranges::count_if(image.pixels, [&](const Float3& p) { return !(p == image.at(0, 0)); });
  };
  const auto expected = static_cast<double>(hits(std::nullopt));
  EXPECT_GT(expected, 100);
  for (const float bias : {0.0F, 1.0F, 2.0F, 3.0F}) {
    EXPECT_NEAR(static_cast<double>(hits(LevelOfDetail{bias, 0})), expected, 0.25 * expected) << bias;
  }
}

TEST_F(LevelsOfDetail, ScatteredLight_MaySeeCoarserLevelsThanTheCamera) {
  const auto backend = make_cpu_backend(2, {.levels = true});
  const auto volume = backend->load(ball(), 0, nullptr);
  Scene scene = scene_of(RenderMode::path);
  scene.camera.zoom = 4;
  const Picture voxels = picture(*backend, *volume, scene, std::nullopt, 64);
  const Picture light = picture(*backend, *volume, scene, LevelOfDetail{0, 3}, 64);
  EXPECT_GE(light.finest_level, 1);
  EXPECT_NE(light.image.pixels, voxels.image.pixels);
  // The paths differ from where they meet a coarser level, so the pictures differ mostly in noise.
  const float noise = difference(picture(*backend, *volume, scene, std::nullopt, 64, 1).image, voxels.image);
  EXPECT_LT(difference(light.image, voxels.image), 1.25F * noise);
  // Only light on a path scatters.
  scene.mode = RenderMode::dvr;
  scene.camera.zoom = 12;
  EXPECT_EQ(picture(*backend, *volume, scene, LevelOfDetail{0, 3}).finest_level, 0);
}

TEST_F(LevelsOfDetail, CacheOfPackedBlocks_GivesThePictureOfDecodedOnes) {
  const auto packed = file(test::PackedSample::build().file);
  const auto decoding = make_cpu_backend(2, {.levels = true});
  const auto caching = make_cpu_backend(2, {.ceiling = 700 << 10U, .levels = true});
  const auto decoded = decoding->load(packed, 0, nullptr);
  const auto cached = caching->load(packed, 0, nullptr);
  ASSERT_EQ(decoded->load_summary().way, "decoded");
  ASSERT_EQ(cached->load_summary().way, "cached");
  EXPECT_LE(cached->load_summary().memory, std::uint64_t{700 * 7 / 8} << 10U);
  for (const RenderMode mode : kModes) {
    Scene scene = scene_of(mode);
    scene.volume.range = {-100, 800};
    scene.volume.iso = 100;
    const Picture expected = picture(*decoding, *decoded, scene, LevelOfDetail{2, 1}, 2);
    const Picture found = picture(*caching, *cached, scene, LevelOfDetail{2, 1}, 2);
    EXPECT_GE(found.finest_level, 2);
    EXPECT_EQ(found.finest_level, expected.finest_level);
    EXPECT_EQ(found.image.pixels, expected.image.pixels) << render_mode_name(mode);
  }
}

TEST_F(LevelsOfDetail, DenseVolume_HasThoseOfItsFile) {
  const auto source = ball();
  auto values = std::make_unique<float[]>(96 * 96 * 96);
  const LeafTable table(source->grid());
  for (std::int32_t i = 0; i < 96 * 96 * 96; ++i) {
    values[static_cast<std::size_t>(i)] = table.view().voxel({i % 96, i / 96 % 96, i / 96 / 96});
  }
  const auto backend = make_cpu_backend(2, {.levels = true});
  const auto dense =
      backend->load_dense(std::make_shared<const DenseVolume>(frame_of(source->grid()), std::move(values), 0.0F), 0);
  const auto stored = backend->load(source, 0, nullptr);
  for (const RenderMode mode : kModes) {
    EXPECT_EQ(picture(*backend, *dense, scene_of(mode), LevelOfDetail{2, 0}, 2).image.pixels,
              picture(*backend, *stored, scene_of(mode), LevelOfDetail{2, 0}, 2).image.pixels)
        << render_mode_name(mode);
  }
}

// 96^3 voxels: level 1 takes 0.5 MiB, level 2 0.07.
TEST_F(LevelsOfDetail, MemoryForCoarserLevelsAlone_IsSaid) {
  for (const auto& [kib, finest] : {std::pair{8192, 1}, std::pair{1024, 2}}) {
    const auto backend =
        make_cpu_backend(1, {.ceiling = std::uint64_t{static_cast<unsigned>(kib)} << 10U, .levels = true});
    const auto volume = backend->load(ball(), 0, nullptr);
    const Picture found = picture(*backend, *volume, scene_of(RenderMode::dvr), LevelOfDetail{}, 2);
    EXPECT_EQ(found.finest_level, finest);
    EXPECT_EQ(found.levels_note, finest == 1
                                     ? ""
                                     : "levels of detail from 1 on were asked for, those from 2 on fit into the "
                                       "memory kept for them");
  }
  const std::string asked = "levels of detail from 1 on were asked for, ";
  EXPECT_EQ(levels_note(3, 1, 2.5F), asked + "those from 3 on fit into the memory kept for them");
  EXPECT_EQ(
      levels_note(3, 1, 2),
      asked + "those from 3 on fit into the memory kept for them, of which none was of use; " + "voxels were read");
  EXPECT_EQ(levels_note(0, 1, 2), asked + "but there is no memory for them; voxels were read");
}

}  // namespace
}  // namespace weir::levels_test
