#include "compressor/leaf/leaf_difference.h"

#include <gtest/gtest.h>

#include <limits>

namespace weir::leaf_difference_test {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

struct Pair {
  LeafValues source{};
  LeafValues decoded{};
  LeafDifference difference() const { return difference_of(source, decoded); }
};

TEST(LeafDifference, EqualLeavesDoNotDiffer) {
  Pair leaf;
  leaf.source.fill(0.25F);
  leaf.decoded.fill(0.25F);
  const LeafDifference d = leaf.difference();
  EXPECT_EQ(d.squared_error, 0.0);
  EXPECT_EQ(d.max_abs, 0.0);
  EXPECT_EQ(d.different, 0U);
  EXPECT_EQ(d.range.min, 0.25F);
  EXPECT_EQ(d.range.max, 0.25F);
}

TEST(LeafDifference, DifferenceInAnyVoxelIsCounted) {
  for (std::size_t i = 0; i < 512; ++i) {
    Pair leaf;
    leaf.source[i] = 3.0F;
    leaf.decoded[i] = -1.0F;
    const LeafDifference d = leaf.difference();
    ASSERT_EQ(d.squared_error, 16.0) << i;
    ASSERT_EQ(d.max_abs, 4.0) << i;
    ASSERT_EQ(d.different, 1U) << i;
    ASSERT_EQ(d.range.max, 3.0F) << i;
  }
}

TEST(LeafDifference, DifferenceIsTakenInDouble) {
  Pair leaf;
  leaf.source.fill(3e38F);
  leaf.decoded.fill(-3e38F);
  const double difference = static_cast<double>(3e38F) * 2;
  EXPECT_EQ(leaf.difference().max_abs, difference);
  EXPECT_EQ(leaf.difference().squared_error, 512 * (difference * difference));
}

TEST(LeafDifference, NegativeZeroDiffersInBitsOnly) {
  Pair leaf;
  leaf.source[7] = -0.0F;
  const LeafDifference d = leaf.difference();
  EXPECT_EQ(d.squared_error, 0.0);
  EXPECT_EQ(d.max_abs, 0.0);
  EXPECT_EQ(d.different, 1U);
}

TEST(LeafDifference, NonFiniteValuesAreCountedAndLeftOut) {
  Pair leaf;
  leaf.source[0] = kNaN;  // decodes to 0
  leaf.source[1] = kInf;  // decodes to +Inf: the same bits
  leaf.decoded[1] = kInf;
  leaf.source[2] = -kInf;  // decodes to +Inf
  leaf.decoded[2] = kInf;
  leaf.decoded[3] = kNaN;  // the source is 0
  leaf.source[4] = 2.0F;
  const LeafDifference d = leaf.difference();
  EXPECT_EQ(d.nonfinite, 3U);
  EXPECT_EQ(d.nonfinite_decoded, 1U);
  EXPECT_EQ(d.different, 2U);
  EXPECT_EQ(d.nonfinite_different, 2U);
  EXPECT_EQ(d.squared_error, 4.0);
  EXPECT_EQ(d.max_abs, 2.0);
  EXPECT_EQ(d.range.min, 0.0F);
  EXPECT_EQ(d.range.max, 2.0F);
}

TEST(LeafDifference, WithoutAFiniteVoxelThereIsNoRange) {
  Pair leaf;
  leaf.source.fill(kNaN);
  const LeafDifference d = leaf.difference();
  EXPECT_EQ(d.nonfinite, 512U);
  EXPECT_EQ(d.squared_error, 0.0);
  EXPECT_GT(d.range.min, d.range.max);
}

TEST(LeafDifference, VoxelsOutsideDoNotCount) {
  const Box node{{8, 0, -8}, {16, 8, 0}};
  const Box inside{{10, 0, -8}, {16, 7, -1}};
  Pair leaf;
  leaf.source.fill(3.0F);
  leaf.decoded.fill(1.0F);
  const LeafValues seen = inside_only(leaf.source, leaf.decoded, node, inside);
  for_each_index(node, [&](const Index3& i) {
    const Index3 at = i - node.lo;
    EXPECT_EQ(seen[static_cast<std::size_t>(at.x << 6 | at.y << 3 | at.z)], inside.contains(i) ? 3.0F : 1.0F);
  });
  EXPECT_EQ(difference_of(seen, leaf.decoded).different, 6U * 7U * 7U);
}

TEST(AbsDifference, ZeroWhereEitherIsNotFinite) {
  EXPECT_EQ(abs_difference(1.0F, -2.0F), 3.0);
  EXPECT_EQ(abs_difference(kNaN, 1.0F), 0.0);
  EXPECT_EQ(abs_difference(1.0F, kInf), 0.0);
}

}  // namespace
}  // namespace weir::leaf_difference_test
