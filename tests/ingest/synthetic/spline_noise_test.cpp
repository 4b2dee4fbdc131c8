#include "ingest/synthetic/spline_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "ingest/synthetic/hash.h"

namespace weir::spline_noise_test {
namespace {

// Returns the noise by its definition, in double: the sum over octaves and 4^3 nodes.
double reference(const SplineNoise& noise, const Index3& i) {
  const auto basis = [](double t, int tap) {
    const double s = 1 - t;
    switch (tap) {
      case 0:
        return s * s * s / 6;
      case 1:
        return (3 * t * t * t - 6 * t * t + 4) / 6;
      case 2:
        return (3 * s * s * s - 6 * s * s + 4) / 6;
      default:
        return t * t * t / 6;
    }
  };
  double sum = 0;
  for (const NoiseOctave& octave : noise.octaves()) {
    const std::int64_t period = std::int64_t{1} << octave.shift;
    const Index3 p = i + octave.offset;
    const Index3 cell = floor_div(p, period);
    const auto phase = [&](std::int64_t v) {
      return (static_cast<double>(v % period) + 0.5) / static_cast<double>(period);
    };
    for (int c = 0; c < 4; ++c) {
      for (int b = 0; b < 4; ++b) {
        for (int a = 0; a < 4; ++a) {
          const float node = 2 * unit_float(hash_position(octave.key, cell.x + a, cell.y + b, cell.z + c)) - 1;
          sum += static_cast<double>(node) * static_cast<double>(octave.amplitude) * basis(phase(p.x), a) *
                 basis(phase(p.y), b) * basis(phase(p.z), c);
        }
      }
    }
  }
  return sum;
}

TEST(SplineNoise, AgreesWithItsDefinition) {
  const SplineNoise noise(11, {600, 8, 8}, 0.7F, 1.0F);
  const Box box{{37, 64, 100}, {62, 80, 117}};
  TileNoise tile(noise, box);
  std::array<float, 32> row{};
  float highest = -1e30F;
  for (std::int64_t z = box.lo.z; z < box.hi.z; ++z) {
    const float bound = tile.set_plane(z);
    EXPECT_LE(bound, tile.upper_bound() + 1e-4F);
    for (std::int64_t y = box.lo.y; y < box.hi.y; ++y) {
      row.fill(0.0F);
      tile.add_row(y, row.data());
      for (std::int64_t x = box.lo.x; x < box.hi.x; ++x) {
        const float value = row[static_cast<std::size_t>(x - box.lo.x)];
        ASSERT_NEAR(value, reference(noise, {x, y, z}), 2e-6) << x << ' ' << y << ' ' << z;
        ASSERT_LE(value, bound);
        highest = std::max(highest, value);
      }
    }
  }
  EXPECT_LE(highest, tile.upper_bound());
  EXPECT_LE(tile.upper_bound(), noise.amplitude_sum() * 1.0001F);
}

TEST(SplineNoise, OctavesHalveThePeriodAndShrinkByTheGain) {
  const SplineNoise noise(1, {128, 8, 8}, 0.5F, 1.0F);
  ASSERT_EQ(noise.octaves().size(), 4U);
  EXPECT_EQ(noise.octaves()[0].shift, 5U);
  EXPECT_EQ(noise.octaves()[3].shift, 2U);
  EXPECT_EQ(noise.octaves()[3].amplitude, noise.octaves()[0].amplitude * 0.125F);
}

TEST(SplineNoise, CoarsestPeriodFollowsTheLongestAxis) {
  const auto coarsest = [](const Index3& extent) { return SplineNoise(1, extent, 0.5F, 1.0F).octaves().front().shift; };
  EXPECT_EQ(coarsest({1, 1, 1}), 2U);
  EXPECT_EQ(coarsest({64, 8, 8}), 4U);
  EXPECT_EQ(coarsest({8, 512, 8}), 7U);
  EXPECT_EQ(coarsest({8, 8, 1290}), 8U);
  EXPECT_EQ(coarsest({1 << 20, 8, 8}), 10U);
}

TEST(Hash, NeighboursDifferInHalfOfTheirBits) {
  // Every output bit flips for about half of the steps to a neighbour.
  for (unsigned bit = 0; bit < 64; ++bit) {
    int flips = 0;
    for (std::int64_t i = 0; i < 1000; ++i) {
      const std::uint64_t change = hash_position(5, i, 7, -3) ^ hash_position(5, i, 8, -3);
      flips += static_cast<int>(change >> bit & 1U);
    }
    EXPECT_NEAR(flips, 500, 90) << bit;
  }
}

TEST(Hash, UnitFloatStartsAtZeroAndStaysBelowOne) {
  EXPECT_EQ(unit_float(0), 0.0F);
  EXPECT_EQ(unit_float(~std::uint64_t{0}), 1.0F - 0x1p-24F);
}

}  // namespace
}  // namespace weir::spline_noise_test
