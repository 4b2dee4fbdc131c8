#include "gpu/render/render_scene.h"

#include <gtest/gtest.h>

#include <cfloat>

#include "format/base/error.h"
#include "tests/stock/test_grid.h"

namespace weir::render_scene_test {
namespace {

using test::TestGrid;
using test::TestGridOptions;

float ramp(const Index3& i) { return static_cast<float>(i.x); }

TEST(RenderScene, LengthsAreInShortestVoxelEdges) {
  TestGridOptions options;
  options.voxel_size = {0.5, 0.25, 1};
  const TestGrid grid({{0, 0, 0}, {41, 20, 10}}, ramp, options);
  Scene scene;
  scene.volume.density = 164;
  const RenderScene prepared(grid.grid(), scene, {});
  EXPECT_EQ(prepared.task().medium.stretch, (Float3{2, 1, 4}));
  EXPECT_EQ(prepared.task().medium.density, 2.0F) << "over the longest edge, 41 voxels of 2";
}

TEST(RenderScene, DensityAlongAnotherFrame_IsTheSameExtinctionInTheWorld) {
  TestGridOptions options;
  options.voxel_size = {0.5, 0.25, 1};
  const TestGrid grid({{0, 0, 0}, {41, 20, 10}}, ramp, options);
  Scene scene;
  scene.volume.density = 164;
  RenderOptions along;
  along.density_frame = frame_of(grid.grid());
  EXPECT_EQ(RenderScene(grid.grid(), scene, along).task().medium.density, 2.0F) << "its own";
  // 8 per world unit over an edge of 20.5, 2 over an edge of 82; a shortest voxel edge is a quarter of a unit.
  along.density_frame = GridFrame{{{0, 0, 0}, {1, 41, 1}}, {2, 2, 2}, {0, 0, 0}};
  EXPECT_EQ(RenderScene(grid.grid(), scene, along).task().medium.density, 0.5F);
  along.density_frame = GridFrame{{{0, 0, 0}, {1, 41, 1}}, {1e-300, 1e-300, 1e-300}, {0, 0, 0}};
  EXPECT_EQ(RenderScene(grid.grid(), scene, along).task().medium.density, FLT_MAX);
}

TEST(RenderScene, DefaultIsoLiesBetweenBackgroundAndFarthestValue) {
  TestGridOptions options;
  options.background = 10;
  const TestGrid grid({{0, 0, 0}, {41, 20, 10}}, ramp, options);
  EXPECT_NEAR(RenderScene(grid.grid(), {}, {}).task().iso, 10 + 0.35F * 30, 1e-4F);
  options.background = 35;
  const TestGrid other({{0, 0, 0}, {41, 20, 10}}, ramp, options);
  EXPECT_NEAR(RenderScene(other.grid(), {}, {}).task().iso, 35 - 0.35F * 35, 1e-4F);
}

TEST(RenderScene, SceneAndOptionsAreCopiedToTheTask) {
  const TestGrid grid({{0, 0, 0}, {41, 20, 10}}, ramp);
  Scene scene;
  scene.mode = RenderMode::iso;
  scene.volume.iso = 7;
  scene.volume.albedo = 0.5;
  scene.volume.anisotropy = 0.25;
  scene.volume.emission = 2;
  scene.volume.shading = 0.125;
  scene.volume.max_bounces = 9;
  scene.lighting.zenith = {{1, 2, 3}};
  scene.lighting.background = {{4, 5, 6}};
  scene.lighting.exposure = 3;
  scene.lighting.lights = {{{{0, 0, 2}, {7, 8, 9}}}};
  RenderOptions options;
  options.width = 10;
  options.height = 20;
  options.seed = 99;
  options.cell = 32;
  options.filter = Filter::stochastic;
  const RenderScene prepared(grid.grid(), scene, options);
  const RenderTask<VolumeSampler>& task = prepared.task();
  EXPECT_EQ(task.mode, RenderMode::iso);
  EXPECT_EQ(task.iso, 7.0F);
  EXPECT_EQ(task.medium.albedo, 0.5F);
  EXPECT_EQ(task.medium.g, 0.25F);
  EXPECT_EQ(task.medium.emission, 2.0F);
  EXPECT_EQ(task.medium.cells.edge, 32.0F);
  EXPECT_EQ(task.medium.volume.filter, Filter::stochastic);
  EXPECT_EQ(task.shading, 0.125F);
  EXPECT_EQ(task.max_bounces, 9);
  EXPECT_EQ(task.lighting.zenith, (Float3{1, 2, 3}));
  EXPECT_EQ(task.lighting.background, (Float3{4, 5, 6}));
  ASSERT_EQ(task.lighting.light_count, 1);
  EXPECT_EQ(task.lighting.lights[0].direction, (Float3{0, 0, 1}));
  EXPECT_EQ(task.lighting.lights[0].irradiance, (Float3{7, 8, 9}));
  EXPECT_EQ(task.seed, 99U);
  EXPECT_EQ(prepared.tone().exposure, 3.0F);
}

TEST(RenderScene, FramesTheVolumeOrItsContent) {
  const TestGrid grid({{0, 0, 0}, {160, 160, 160}},
                      [](const Index3& i) { return i.x < 8 && i.y < 8 && i.z < 8 ? 1.0F : 0.0F; });
  Scene scene;
  const Float3 content = RenderScene(grid.grid(), scene, {}).task().camera.position;
  scene.camera.framing = Framing::volume;
  const Float3 volume = RenderScene(grid.grid(), scene, {}).task().camera.position;
  EXPECT_LT(length(content), 0.3F * length(volume));
}

// Samples are counted in floats, so a needle of 10^7 voxels must not stall the march.
TEST(RenderScene, StepGrowsWithExtremeLengths) {
  TestGridOptions options;
  options.tiles = {{{0, 0, 0}, 8, 1, true}, {{10000000 / 8 * 8, 0, 0}, 8, 1, true}};
  const TestGrid grid({}, ramp, options);
  EXPECT_GT(RenderScene(grid.grid(), {}, {}).task().step, 1e7F / (1 << 22));
}

TEST(RenderScene, ShowsTheRegionOnly) {
  const TestGrid grid({{-8, 0, 0}, {33, 20, 10}}, ramp);
  Scene scene;
  scene.mode = RenderMode::mip;
  scene.camera.framing = Framing::volume;
  EXPECT_EQ(RenderScene(grid.grid(), scene, {}).task().medium.shown.high, (Float3{41, 20, 10}));
  scene.volume.region = Box{{-100, 4, 2}, {8, 12, 9}};
  const RenderScene prepared(grid.grid(), scene, {});
  EXPECT_EQ(prepared.task().medium.shown.low, (Float3{0, 4, 2})) << "from the domain's corner, inside it";
  EXPECT_EQ(prepared.task().medium.shown.high, (Float3{16, 12, 9}));
  // Along x through the region: the ramp's largest value is between the last voxel's centre and the next.
  const Medium<VolumeSampler>& medium = prepared.task().medium;
  Ray ray{{-5, 8, 5}, {1, 0, 0}};
  const float length = enter(ray, medium.shown);
  EXPECT_EQ(length, 16.0F);
  EXPECT_NEAR(max_along(medium, ray, length, 0.25F, 0.0F), 7.5F, 0.3F);
  Ray beside{{-5, 2, 5}, {1, 0, 0}};
  EXPECT_EQ(enter(beside, medium.shown), 0.0F);
}

TEST(RenderScene, RefusesARegionOutsideTheVolume) {
  const TestGrid grid({{0, 0, 0}, {41, 20, 10}}, ramp);
  Scene scene;
  scene.volume.region = Box{{0, 20, 0}, {41, 30, 10}};
  try {
    const RenderScene prepared(grid.grid(), scene, {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    EXPECT_STREQ(error.what(),
                 "the scene's region shows no voxel of the volume, whose index box is [[0, 41], [0, 20], [0, 10]]");
  }
}

}  // namespace
}  // namespace weir::render_scene_test
