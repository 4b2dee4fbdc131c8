#include "ingest/values/axis_placement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace weir::axis_placement_test {
namespace {

TEST(AxisPlacement, AxesAlongTheWorldKeepSpacingAndOrigin) {
  const std::vector<Vector3> steps{{0.5, 0, 0}, {0, 0.25, 0}, {0, 0, 3}};
  const AxisPlacement placement = place_axes(steps, {-1, 2, 7});
  EXPECT_EQ(placement.spacing, (Vector3{0.5, 0.25, 3}));
  EXPECT_EQ(placement.origin, (Vector3{-1, 2, 7}));
  EXPECT_EQ(placement.orientation, "");
}

TEST(AxisPlacement, PermutedAxesReorderTheOriginWithANote) {
  const std::vector<Vector3> steps{{0, 0, 2}, {-3, 0, 0}, {0, 4, 0}};
  const AxisPlacement placement = place_axes(steps, {10, 20, 30});
  EXPECT_EQ(placement.spacing, (Vector3{2, 3, 4}));
  EXPECT_EQ(placement.origin, (Vector3{30, 10, 20}));
  EXPECT_EQ(placement.orientation, "axes along +z, -x, +y of the file's world; voxels keep the file's order");
}

// OpenVDB's map and VTK's image place index i at zero + i * step.
TEST(AxisPlacement, FirstIndexOfAFallingAxis_LiesWhereTheFileSays) {
  const std::vector<Vector3> steps{{1, 0, 0}, {0, 2, 0}, {0, 0, -3}};
  const AxisPlacement placement = place_axes(steps, {10, 20, 30}, {-9, 2, -3});
  EXPECT_EQ(placement.spacing, (Vector3{1, 2, 3}));
  EXPECT_EQ(placement.origin, (Vector3{10, 20, 48})) << "origin + first * spacing = 39 = 30 + first * step";
  EXPECT_EQ(placement.orientation, "axes along +x, +y, -z of the file's world; voxels keep the file's order");

  const std::vector<Vector3> turned{{0, 0, 2}, {-3, 0, 0}, {0, 4, 0}};
  EXPECT_EQ(place_axes(turned, {10, 20, 30}, {5, 6, 7}).origin, (Vector3{30, 10 - 2 * 6 * 3, 20}));
}

TEST(AxisPlacement, FirstIndexOfRisingAndObliqueAxes_DoesNotMoveTheOrigin) {
  const std::vector<Vector3> rising{{0.1, 0, 0}, {0, 0.3, 0}, {0, 0, 0.7}};
  EXPECT_EQ(place_axes(rising, {0.1, 0.2, 0.3}, {-7, 11, 13}).origin, (Vector3{0.1, 0.2, 0.3}));
  const std::vector<Vector3> oblique{{3, 4, 0}, {-4, 3, 0}, {0, 0, -2}};
  EXPECT_EQ(place_axes(oblique, {1, 2, 3}, {-7, 11, 13}).origin, (Vector3{1, 2, 3}));
}

TEST(AxisPlacement, IgnoresRoundingErrors) {
  const std::vector<Vector3> steps{{2, 1e-7, 0}, {0, 2, -1e-7}, {0, 0, 2}};
  EXPECT_EQ(place_axes(steps, {}).orientation, "");
  EXPECT_EQ(place_axes(steps, {}).spacing, (Vector3{2, 2, 2}));
}

TEST(AxisPlacement, ObliqueAxesGiveStepLengthsAsSpacing) {
  const std::vector<Vector3> steps{{3, 4, 0}, {-4, 3, 0}, {0, 0, 2}};
  const AxisPlacement placement = place_axes(steps, {1, 2, 3});
  EXPECT_EQ(placement.spacing, (Vector3{5, 5, 2}));
  EXPECT_EQ(placement.origin, (Vector3{1, 2, 3}));
  EXPECT_EQ(placement.orientation, "axes oblique to the file's world, ignored: spacing is the length of a step");
}

TEST(AxisPlacement, ParallelAxesCountAsOblique) {
  const std::vector<Vector3> steps{{1, 0, 0}, {2, 0, 0}, {0, 0, 1}};
  EXPECT_TRUE(place_axes(steps, {}).orientation.starts_with("axes oblique"));
}

TEST(AxisPlacement, AxesWithoutAStepTakeTheRemainingWorldAxes) {
  EXPECT_EQ(place_axes({}, {1, 2, 3}).origin, (Vector3{1, 2, 3}));
  const std::vector<Vector3> steps{{0, 2, 0}, {0, 0, 3}};
  const AxisPlacement placement = place_axes(steps, {1, 2, 3});
  EXPECT_EQ(placement.spacing, (Vector3{2, 3, 1}));
  EXPECT_EQ(placement.origin, (Vector3{2, 3, 1}));
  const std::vector<Vector3> plane{{2, 0, 0}, {0, 3, 0}};
  EXPECT_EQ(place_axes(plane, {}).orientation, "");
}

TEST(AxisPlacement, ZeroAndNaNStepsArePassedOn) {
  const std::vector<Vector3> steps{{0, 0, 0}, {0, 1, 0}, {0, 0, std::nan("")}};
  const AxisPlacement placement = place_axes(steps, {});
  EXPECT_EQ(placement.spacing[0], 0);
  EXPECT_TRUE(std::isnan(placement.spacing[2]));
}

}  // namespace
}  // namespace weir::axis_placement_test
