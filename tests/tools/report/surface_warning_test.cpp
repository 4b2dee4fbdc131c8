#include "tools/report/surface_warning.h"

#include <gtest/gtest.h>

#include <string>

namespace weir::surface_warning_test {
namespace {

std::string warning(double iso, const MinMax& values) {
  Scene scene;
  scene.mode = RenderMode::iso;
  scene.volume.iso = iso;
  return surface_warning(scene, values);
}

TEST(SurfaceWarning, ValueOutside_IsToldFromTheEndThatItPasses) {
  EXPECT_EQ(warning(7, {0, 0.75F}), "the iso value 7 lies outside the values, 0 .. 0.75: the picture shows no surface");
  EXPECT_EQ(warning(0.74, {0, 0.73997F}),
            "the iso value 0.74 lies outside the values, 0 .. 0.73997: the picture shows no surface");
  EXPECT_EQ(warning(-0.1, {0.5F, 2}),
            "the iso value -0.1 lies outside the values, 0.5 .. 2: the picture shows no surface");
  EXPECT_EQ(warning(0.1, {0, 0.1F - 1e-8F}),
            "the iso value 0.1 lies outside the values, 0 .. 0.09999999: the picture shows no surface");
}

TEST(SurfaceWarning, LowestValue_IsToldSinceNoneIsBelow) {
  EXPECT_EQ(warning(0, {0, 0.75F}),
            "the iso value 0 is the lowest of the values, up to 0.75: the picture shows no surface");
  EXPECT_EQ(warning(7, {7, 7}), "the iso value 7 is the lowest of the values, up to 7: the picture shows no surface");
}

TEST(SurfaceWarning, DefaultValue_IsMentionedWhereAllValuesAreOne) {
  Scene scene;
  scene.mode = RenderMode::iso;
  EXPECT_EQ(surface_warning(scene, {0.5F, 0.5F}), "every voxel has the value 0.5: the picture shows no surface");
  EXPECT_EQ(surface_warning(scene, {0.5F, 0.75F}), "");
  scene.mode = RenderMode::dvr;
  EXPECT_EQ(surface_warning(scene, {0.5F, 0.5F}), "");
}

TEST(SurfaceWarning, ValueInside_IsNotMentioned) {
  EXPECT_EQ(warning(0.75, {0, 0.75F}), "");
  EXPECT_EQ(warning(0.1, {0, 0.75F}), "");
  Scene scene;
  scene.volume.iso = 7;
  scene.mode = RenderMode::mip;
  EXPECT_EQ(surface_warning(scene, {0, 1}), "");
}

}  // namespace
}  // namespace weir::surface_warning_test
