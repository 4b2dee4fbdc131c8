#include "compressor/survey/visibility.h"

#include <gtest/gtest.h>

#include <string>

#include "format/base/error.h"
#include "format/leaf/bounds.h"

namespace weir::visibility_test {
namespace {

constexpr Box kDomain{{0, 0, 0}, {64, 64, 64}};

// The range [0, 1023] makes values equal entries of the table. The opacity is 0 in the lower half, then a ramp to 0.5
// at 767, and flat from there.
Scene ramp() {
  Scene scene;
  scene.volume.range = {0, 1023};
  scene.volume.opacity = {{0, 0}, {511.0 / 1023, 0}, {767.0 / 1023, 0.5}, {1, 0.5}};
  return scene;
}

Visibility visibility(const Scene& scene, Visibility::Weighing weighing = Visibility::Weighing::by_picture) {
  return {scene, "s.toml", kDomain, weighing};
}

std::string message(const Scene& scene) {
  try {
    visibility(scene);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    return error.what();
  }
  return "no error";
}

TEST(Visibility, ShowsIntervalsThatTouchAnOpacity) {
  const Visibility v = visibility(ramp());
  EXPECT_FALSE(v.shows({-1e30F, 511}));
  EXPECT_FALSE(v.shows({100, 100}));
  EXPECT_TRUE(v.shows({100, 511.5F})) << "the table's next entry has an opacity";
  EXPECT_TRUE(v.shows({512, 512}));
  EXPECT_TRUE(v.shows({2000, 3000})) << "beyond the range the end's opacity holds";
  EXPECT_FALSE(v.shows(kNoBounds));
}

TEST(Visibility, WeighsByTheSteepestChange) {
  const Visibility v = visibility(ramp());
  EXPECT_EQ(v.weight({0, 511}), 0);
  EXPECT_EQ(v.weight(kNoBounds), 0);
  // The ramp rises by 0.5 over 256 of 1023 parts of the range. In addition the colours change where it is opaque.
  const double slope = 0.5 * 1023 / 256;
  EXPECT_NEAR(v.weight({511, 767}), (slope + 0.5) * (slope + 0.5), 1e-4);
  EXPECT_NEAR(v.weight({511, 639}), (slope + 0.25) * (slope + 0.25), 1e-4);
  EXPECT_NEAR(v.weight({800, 900}), 0.25, 1e-6) << "only the colour changes";
  EXPECT_EQ(v.weight({1500, 2000}), 0) << "one opacity and one colour beyond the range";
  EXPECT_GE(v.weight({0, 1023}), v.weight({511, 639})) << "never less for more values";
}

TEST(Visibility, WeighingAlikeGivesVisibleIntervalsWeightOne) {
  const Visibility v = visibility(ramp(), Visibility::Weighing::alike);
  EXPECT_EQ(v.weight({0, 511}), 0);
  EXPECT_EQ(v.weight({511, 600}), 1);
  EXPECT_EQ(v.weight({1500, 2000}), 1);
  EXPECT_EQ(v.weight(kNoBounds), 0);
}

TEST(Visibility, AnIsoSurfaceLiesInIntervalsThatHoldItsValue) {
  Scene scene;
  scene.mode = RenderMode::iso;
  scene.volume.iso = 0.25;
  const Visibility v = visibility(scene);
  EXPECT_TRUE(v.shows({0, 0.25F}));
  EXPECT_FALSE(v.shows({0.26F, 1}));
  EXPECT_EQ(v.weight({0, 1}), 1);
  EXPECT_EQ(v.weight({0.5F, 1}), 0);
}

TEST(Visibility, RangeOfOneValueIsAStepAtThatValue) {
  Scene scene;
  scene.volume.range = {5, 5};
  scene.volume.opacity = {{0, 0}, {0.75, 0}, {1, 1}};
  const Visibility v = visibility(scene);
  EXPECT_FALSE(v.shows({-1, 5}));
  EXPECT_TRUE(v.shows({5, 6}));
}

TEST(Visibility, FiltersReachOneVoxelIntoTheRegion) {
  Scene scene;
  scene.volume.region = Box{{17, 17, 17}, {32, 32, 32}};
  const Visibility v = visibility(scene);
  EXPECT_FALSE(v.in_region({{8, 16, 16}, {16, 24, 24}})) << "its last voxel is 15, the region's first 17";
  EXPECT_TRUE(v.in_region({{9, 16, 16}, {17, 24, 24}}));
  EXPECT_TRUE(v.in_region({{32, 16, 16}, {40, 24, 24}}));
  EXPECT_FALSE(v.in_region({{33, 16, 16}, {41, 24, 24}}));
  EXPECT_TRUE(v.shows({-1, 1})) << "without opacities every value is seen";
}

TEST(Visibility, RefusesScenesWithoutVisibilitySettings) {
  EXPECT_EQ(message(Scene{}),
            "s.toml: nothing in it says what can be seen; give [volume] opacity and range, or region, or leave out "
            "--scene");
  Scene iso;
  iso.mode = RenderMode::iso;
  iso.volume.opacity = {{0, 0}, {1, 1}};
  EXPECT_EQ(message(iso),
            "s.toml: nothing in it says what can be seen; give [volume] iso, or region, or leave out --scene");
  Scene open = ramp();
  open.volume.range.reset();
  EXPECT_EQ(message(open),
            "s.toml: [volume] opacity needs range = [low, high] to say which values it hides; a file's own range "
            "changes with what is left out");
  Scene outside;
  outside.volume.region = Box{{64, 0, 0}, {65, 64, 64}};
  EXPECT_EQ(message(outside),
            "s.toml: [volume] region shows no voxel of the volume, whose index box is [[0, 64], [0, 64], [0, 64]]; "
            "give one inside it");
}

}  // namespace
}  // namespace weir::visibility_test
