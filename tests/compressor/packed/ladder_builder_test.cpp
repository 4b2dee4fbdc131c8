// Near rungs of several kinds of blocks: their bytes and errors, and that there is none if the exact stream is shorter.
#include "compressor/packed/ladder_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "compressor/leaf/leaf_summary.h"

namespace weir::ladder_builder_test {
namespace {

PackedLadder ladder_of(const LeafValues& block) {
  LadderAim aim;
  aim.near_rungs = true;
  return LadderBuilder(aim).build(block, summarize_leaf(block, 0), NearRungs::yes);
}

LeafValues filled(float (*value)(double x, double y, double z)) {
  LeafValues block;
  for (std::size_t i = 0; i < block.size(); ++i) {
    const auto place = static_cast<unsigned>(i);
    block[i] = value(place >> 6U, place >> 3U & 7U, place & 7U);
  }
  return block;
}

std::vector<RungPoint> near_points(const PackedLadder& ladder) {
  std::vector<RungPoint> points;
  for (std::size_t rung = 0; rung < ladder.near_count; ++rung) {
    if (const auto point = ladder.near_point(rung)) points.push_back(*point);
  }
  return points;
}

void expect_falling(const std::vector<RungPoint>& points) {
  EXPECT_LT(points.front().bytes, points.back().bytes);
  for (std::size_t i = 1; i < points.size(); ++i) EXPECT_LT(points[i].share, points[i - 1].share) << i;
}

TEST(LadderBuilder, NearRungsOfASmoothBlockTakeFewerBytesTheMoreTheyLose) {
  const PackedLadder ladder = ladder_of(filled([](double x, double y, double z) {
    return static_cast<float>(std::sin(0.3 * x + 0.2 * y) + std::cos(0.4 * z));
  }));
  EXPECT_GE(near_points(ladder).size(), 10U);
  expect_falling(near_points(ladder));
  EXPECT_EQ(ladder.exact, ExactKind::ordered);
}

// Rounded to the coarser of the usual quanta, the block has only one value.
TEST(LadderBuilder, BlocksFarFromZeroHaveNearRungs) {
  const PackedLadder ladder = ladder_of(filled([](double x, double y, double z) {
    return static_cast<float>(1000 + 0.02 * (std::sin(0.3 * x + 0.2 * y) + std::cos(0.4 * z)));
  }));
  EXPECT_GE(near_points(ladder).size(), 3U);
  expect_falling(near_points(ladder));
  EXPECT_FALSE(ladder.near_point(0));
}

TEST(LadderBuilder, LatticeIsOfStoredWholeNumbersOnly) {
  SourceInfo source;
  source.type = ScalarType::int8;
  ASSERT_TRUE(lattice_of(source).has_value());
  EXPECT_EQ(lattice_of(source)->minimum, -128.0F);
  EXPECT_EQ(lattice_of(source)->bits, 8U);
  source.lengths = true;
  EXPECT_FALSE(lattice_of(source).has_value()) << "lengths of vectors";
  source.lengths = false;
  source.mapping.scale = 0.5;
  EXPECT_FALSE(lattice_of(source).has_value()) << "scaled values";
  source = {};
  EXPECT_FALSE(lattice_of(source).has_value()) << "floats";
}

TEST(LadderBuilder, BlocksOnALatticeAreExactWithoutTheFloatsOrder) {
  const PackedLadder ladder = ladder_of(
      filled([](double x, double y, double z) { return static_cast<float>(x * x + 3 * y + std::fmod(7 * z, 5)); }));
  EXPECT_EQ(ladder.exact, ExactKind::values);
  EXPECT_LT(ladder.exact_bytes, 1000);
}

// Whole numbers in floats. Rounded to within less than half their distance, they take more bits than exact ones.
TEST(LadderBuilder, ABoundBelowTheStepOfALatticeTakesNoMoreThanExact) {
  const LeafValues block = filled([](double x, double y, double z) {
    return static_cast<float>(std::fmod(37 * x * x + 11 * y * z + 5 * z * z * x, 251));
  });
  const auto bytes = [&](LadderAim aim) {
    return LadderBuilder(aim).build(block, summarize_leaf(block, 0), NearRungs::no).exact_bytes;
  };
  LadderAim lossless;
  lossless.lossless = true;
  LadderAim bounded;
  bounded.max_error = 0.255;
  EXPECT_EQ(bytes(bounded), bytes(lossless));
  bounded.max_error = 3;
  EXPECT_LT(bytes(bounded), bytes(lossless));
}

}  // namespace
}  // namespace weir::ladder_builder_test
