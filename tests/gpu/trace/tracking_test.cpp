#include "gpu/trace/tracking.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/gpu/support/test_medium.h"

namespace weir::tracking_test {
namespace {

using test::Estimate;
using test::estimate;
using test::TestMedium;

constexpr std::uint32_t kDraws = 200000;
constexpr double kSigmas = 4.5;  // allowed deviation of the mean; one false alarm in 1.5e5

const auto kHalf = [](const Float3&) { return 0.5F; };

// Beer-Lambert: T = exp(-sigma d), here through 64 voxels at half opacity.
TEST(DeltaTrack, TransmittanceOfAHomogeneousSlab) {
  for (const float density : {0.002F, 0.02F, 0.1F}) {
    TestMedium medium({64, 64, 64}, 16, density, 1.0F, kHalf);
    const Ray ray = medium->ray({0, 31.5F, 20}, {1, 0, 0});
    const Estimate t = estimate(kDraws, [&](Random& random) {
      return delta_track(*medium, ray, 64, RayKind::camera, random).end == FlightEnd::escaped ? 1.0 : 0.0;
    });
    EXPECT_NEAR(t.mean, std::exp(-0.5 * static_cast<double>(density) * 64), kSigmas * t.sigma) << density;
  }
}

TEST(RatioTrack, TransmittanceOfAHomogeneousSlab) {
  for (const float density : {0.002F, 0.02F, 0.1F}) {
    TestMedium medium({64, 64, 64}, 16, density, 1.0F, kHalf);
    const Ray ray = medium->ray({0, 31.5F, 20}, {1, 0, 0});
    const Estimate t =
        estimate(kDraws, [&](Random& random) { return ratio_track(*medium, ray, 64, RayKind::camera, random); });
    EXPECT_NEAR(t.mean, std::exp(-0.5 * static_cast<double>(density) * 64), kSigmas * t.sigma) << density;
  }
}

// Opacity x / 64 along x: T = exp(-density 64 / 2); majorants differ from cell to cell.
TEST(DeltaTrack, TransmittanceOfARampWithTightMajorants) {
  TestMedium medium({64, 16, 16}, 16, 0.05F, 1.0F, [](const Float3& p) { return p.x / 64; });
  for (std::size_t i = 0; i < 4; ++i) medium.opacity()[i] = 0.25F * static_cast<float>(i + 1);
  const Ray ray = medium->ray({0, 8, 8}, {1, 0, 0});
  const double expected = std::exp(-0.05 * 32);
  const Estimate delta = estimate(kDraws, [&](Random& random) {
    return delta_track(*medium, ray, 64, RayKind::camera, random).end == FlightEnd::escaped ? 1.0 : 0.0;
  });
  EXPECT_NEAR(delta.mean, expected, kSigmas * delta.sigma);
  const Estimate ratio =
      estimate(kDraws, [&](Random& random) { return ratio_track(*medium, ray, 64, RayKind::camera, random); });
  EXPECT_NEAR(ratio.mean, expected, kSigmas * ratio.sigma);
  EXPECT_LT(ratio.sigma, delta.sigma);
}

// A voxel that is twice as long in x is crossed in twice the length.
TEST(DeltaTrack, StretchedVoxelsLengthenThePath) {
  TestMedium medium({32, 32, 32}, 16, 0.05F, 1.0F, kHalf);
  medium->stretch = {2, 1, 1};
  Ray ray = medium->ray({-5, 8, 8}, {1, 0, 0});
  const float length = enter(ray, medium->shown);
  EXPECT_EQ(length, 64.0F);
  const Estimate t = estimate(kDraws, [&](Random& random) {
    return delta_track(*medium, ray, length, RayKind::camera, random).end == FlightEnd::escaped ? 1.0 : 0.0;
  });
  EXPECT_NEAR(t.mean, std::exp(-0.025 * 64), kSigmas * t.sigma);
}

TEST(DeltaTrack, CollisionsLieWhereTheMediumIs) {
  TestMedium medium({64, 16, 16}, 16, 10, 1.0F, [](const Float3& p) { return p.x >= 40 ? 1.0F : 0.0F; });
  const Ray ray = medium->ray({0, 8, 8}, {1, 0, 0});
  for (std::uint32_t i = 0; i < 1000; ++i) {
    Random random(3, 4, i);
    const Flight flight = delta_track(*medium, ray, 64, RayKind::camera, random);
    ASSERT_EQ(flight.end, FlightEnd::collided);
    EXPECT_GE(flight.t, 40.0F);
    EXPECT_LT(flight.t, 43.0F);
  }
}

TEST(DeltaTrack, ZeroExtinctionLetsEverythingPass) {
  TestMedium empty({64, 64, 64}, 16, 1, 0.0F, [](const Float3&) { return 0.0F; });
  TestMedium loose({64, 64, 64}, 16, 1, 1.0F, [](const Float3&) { return 0.0F; });
  for (std::uint32_t i = 0; i < 1000; ++i) {
    Random random(3, 4, i);
    const Ray ray = empty->ray({0, 0, 0}, {0.6F, 0.8F, 0});
    EXPECT_EQ(delta_track(*empty, ray, 50, RayKind::camera, random).end, FlightEnd::escaped);
    EXPECT_EQ(delta_track(*loose, ray, 50, RayKind::camera, random).end, FlightEnd::escaped);
    EXPECT_EQ(ratio_track(*empty, ray, 50, RayKind::camera, random), 1.0F);
    EXPECT_EQ(ratio_track(*loose, ray, 50, RayKind::camera, random), 1.0F);
  }
}

TEST(DeltaTrack, HugeExtinctionStopsAtOnce) {
  for (const float density : {1e6F, 1e30F, 3e38F}) {
    TestMedium wall({64, 64, 64}, 16, density, 1.0F, [](const Float3&) { return 1.0F; });
    const Ray ray = wall->ray({0, 8, 8}, {1, 0, 0});
    for (std::uint32_t i = 0; i < 100; ++i) {
      Random random(3, 4, i);
      const Flight flight = delta_track(*wall, ray, 64, RayKind::camera, random);
      ASSERT_EQ(flight.end, FlightEnd::collided);
      EXPECT_LT(flight.t, 0.25F);
      EXPECT_EQ(ratio_track(*wall, ray, 64, RayKind::camera, random), 0.0F);
    }
  }
}

// The rest of a cell that contains a wall is as clear as without the wall.
TEST(DeltaTrack, HugeMajorantOverVacuum_LetsEverythingPass) {
  for (const float density : {1e4F, 1e30F}) {
    TestMedium medium({64, 64, 64}, 16, density, 1.0F, [](const Float3&) { return 0.0F; });
    const Ray ray = medium->ray({0, 8, 8}, {1, 0, 0});
    Random random(1, 2, 3);
    EXPECT_EQ(delta_track(*medium, ray, 64, RayKind::camera, random).end, FlightEnd::escaped);
    EXPECT_EQ(ratio_track(*medium, ray, 64, RayKind::camera, random), 1.0F);
  }
}

// The longest flight of any realistic volume, along the diagonal of 8192^3 voxels.
TEST(DeltaTrack, HugeMajorantOverALongWay_LetsEverythingPass) {
  for (const float length : {2048.0F, 14189.0F}) {
    TestMedium medium({14192, 16, 16}, 16, 1e30F, 1.0F, [](const Float3&) { return 0.0F; });
    const Ray ray = medium->ray({0, 8, 8}, {1, 0, 0});
    Random random(1, 2, 3);
    EXPECT_EQ(delta_track(*medium, ray, length, RayKind::camera, random).end, FlightEnd::escaped) << length;
    EXPECT_EQ(ratio_track(*medium, ray, length, RayKind::camera, random), 1.0F) << length;
  }
}

TEST(DeltaTrack, TentativeCollisionsWithoutEnd_EndTheFlight) {
  TestMedium medium({32768, 16, 16}, 16, 1e30F, 1.0F, [](const Float3&) { return 0.0F; });
  const Ray ray = medium->ray({0, 8, 8}, {1, 0, 0});
  Random random(1, 2, 3);
  const Flight flight = delta_track(*medium, ray, 32768, RayKind::camera, random);
  EXPECT_EQ(flight.end, FlightEnd::absorbed);
  EXPECT_NEAR(flight.t, 16384, 100) << "of a voxel each 64";
  EXPECT_EQ(ratio_track(*medium, ray, 32768, RayKind::camera, random), 0.0F);
}

// Floats cannot distinguish t from t plus a free path.
TEST(DeltaTrack, TentativeCollisionsThatDoNotMove_EndTheFlight) {
  constexpr std::int32_t kCell = 1 << 24;
  TestMedium medium({2 * kCell, kCell, kCell}, kCell, 1e30F, 1.0F, [](const Float3&) { return 0.0F; });
  medium.opacity()[0] = 0;
  const Ray ray = medium->ray({0, 8, 8}, {1, 0, 0});
  Random random(1, 2, 3);
  const Flight flight = delta_track(*medium, ray, 2.0F * kCell, RayKind::camera, random);
  EXPECT_EQ(flight.end, FlightEnd::absorbed);
  EXPECT_EQ(flight.t, static_cast<float>(kCell));
  EXPECT_EQ(ratio_track(*medium, ray, 2.0F * kCell, RayKind::camera, random), 0.0F);
}

TEST(DeltaTrack, NotANumberIsVacuum) {
  for (const float bad : {NAN, INFINITY, -INFINITY}) {
    TestMedium medium({64, 64, 64}, 16, 1, 1.0F, [bad](const Float3&) { return bad; });
    const Ray ray = medium->ray({0, 8, 8}, {1, 0, 0});
    Random random(1, 2, 3);
    EXPECT_EQ(delta_track(*medium, ray, 64, RayKind::camera, random).end, FlightEnd::escaped);
    EXPECT_EQ(ratio_track(*medium, ray, 64, RayKind::camera, random), 1.0F);
  }
}

}  // namespace
}  // namespace weir::tracking_test
