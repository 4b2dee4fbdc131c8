#include "tools/report/opacity_warning.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace weir::opacity_warning_test {
namespace {

Scene scene_of(std::vector<OpacityPoint> opacity) {
  Scene scene;
  scene.mode = RenderMode::dvr;
  scene.volume.range = {0, 65535};
  scene.volume.opacity = std::move(opacity);
  return scene;
}

Scene labels() {
  const double from = 1000.0 / 65535;
  const double to = 1020.0 / 65535;
  return scene_of({{0, 0}, {from, 0}, {from, 1}, {to, 1}, {to, 0}, {1, 0}});
}

TEST(OpacityWarning, BandThatIsMissed_IsToldByPositionsAndValues) {
  EXPECT_EQ(
      opacity_warning(labels()),
      "opacity 1 at 0.015259 to 0.0155642 of the range (values 1000 to 1020) is taken as 0, since it lies between "
      "two of the 1024 entries that the range has; give a narrower range");
  Scene of_any_range = labels();
  of_any_range.volume.range.reset();
  EXPECT_EQ(opacity_warning(of_any_range),
            "opacity 1 at 0.015259 to 0.0155642 of the range is taken as 0, since it lies between two of the 1024 "
            "entries that the range has; give a narrower range");
}

TEST(OpacityWarning, PeakThatIsLowered_IsToldWithWhatIsLeftOfIt) {
  const double middle = 511.5 / 1023;
  EXPECT_EQ(
      opacity_warning(scene_of({{0, 0}, {middle - 2.0 / 1023, 0}, {middle, 1}, {middle + 2.0 / 1023, 0}, {1, 0}})),
      "opacity 1 at 0.5 of the range (value 32767.5) is taken as at most 0.75, since it lies between two of the "
      "1024 entries that the range has; give a narrower range");
}

TEST(OpacityWarning, WhereOpacityIsMetOrHasNoPart_NothingIsTold) {
  EXPECT_EQ(opacity_warning(Scene{}), "");
  EXPECT_EQ(opacity_warning(scene_of({{0, 0}, {0.01, 0}, {0.02, 1}, {1, 1}})), "");
  Scene surface = labels();
  surface.mode = RenderMode::iso;
  EXPECT_EQ(opacity_warning(surface), "");
  Scene of_one_value = labels();
  of_one_value.volume.range = {7, 7};
  EXPECT_EQ(opacity_warning(of_one_value), "") << "no range is narrower";
}

}  // namespace
}  // namespace weir::opacity_warning_test
