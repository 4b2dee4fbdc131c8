// Near rungs of blocks of several kinds: what they take and lose, and that there are none where exact is shorter.
#include "compressor/packed/ladder_builder.h"

#include <gtest/gtest.h>

#include <cmath>

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

void expect_falling(const PackedLadder& ladder) {
  EXPECT_LT(ladder.near[0].bytes, ladder.near[ladder.near_count - 1U].bytes);
  for (std::size_t i = 1; i < ladder.near_count; ++i) {
    EXPECT_LT(ladder.near[i].error.value(), ladder.near[i - 1].error.value()) << i;
  }
}

TEST(LadderBuilder, NearRungsOfASmoothBlockTakeFewerBytesTheMoreTheyLose) {
  const PackedLadder ladder = ladder_of(filled([](double x, double y, double z) {
    return static_cast<float>(std::sin(0.3 * x + 0.2 * y) + std::cos(0.4 * z));
  }));
  EXPECT_GE(ladder.near_count, 10);
  expect_falling(ladder);
  EXPECT_EQ(ladder.exact, ExactKind::ordered);
}

// Rounded to the coarser ones of the usual quanta, it is of one value.
TEST(LadderBuilder, BlocksFarFromZeroHaveNearRungs) {
  const PackedLadder ladder = ladder_of(filled([](double x, double y, double z) {
    return static_cast<float>(1000 + 0.02 * (std::sin(0.3 * x + 0.2 * y) + std::cos(0.4 * z)));
  }));
  EXPECT_GE(ladder.near_count, 3);
  expect_falling(ladder);
  EXPECT_LT(ladder.near_exponent, -2);
}

TEST(LadderBuilder, BlocksOnALatticeAreExactWithoutTheFloatsOrder) {
  const PackedLadder ladder = ladder_of(
      filled([](double x, double y, double z) { return static_cast<float>(x * x + 3 * y + std::fmod(7 * z, 5)); }));
  EXPECT_EQ(ladder.exact, ExactKind::values);
  EXPECT_LT(ladder.exact_bytes, 1000);
}

}  // namespace
}  // namespace weir::ladder_builder_test
