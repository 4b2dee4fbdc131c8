#include "compressor/leaf/fill.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "compressor/leaf/leaf_summary.h"

namespace weir::fill_test {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

LeafRow row_of(std::vector<float> values) {
  values.resize(8, values.back());
  return summarize_leaf(values, 0);
}

TEST(Fill, TilesHoldTheMeanOrTheBackground) {
  const LeafRow row = row_of({1, 1, 1, 1, 5, 5, 5, 5});
  EXPECT_EQ((Fill{FillMode::mean, 9}.leaf_value(row)), 3);
  EXPECT_EQ((Fill{FillMode::background, 9}.leaf_value(row)), 9);
  EXPECT_EQ((Fill{FillMode::mean, 9}.leaf_value(row_of({kNaN}))), 9);
  EXPECT_TRUE((Fill{FillMode::mean, 9}.active()));
  EXPECT_FALSE((Fill{FillMode::background, 9}.active()));
}

TEST(Fill, ATileIsExactWhereAllBitsAreTheSame) {
  const Fill mean{FillMode::mean, 0, NonFinitePolicy::error};
  EXPECT_TRUE(mean.exact(row_of({2}), 8, 2));
  EXPECT_FALSE(mean.exact(row_of({2}), 8, 3));
  EXPECT_FALSE(mean.exact(row_of({1, 3, 2}), 8, 2));
  EXPECT_TRUE(mean.exact(row_of({-0.0F}), 8, -0.0F));
  EXPECT_FALSE(mean.exact(row_of({-0.0F}), 8, 0.0F));
  EXPECT_FALSE(mean.exact(row_of({-0.0F, 0.0F}), 8, 0.0F));
}

TEST(Fill, NonFiniteVoxelsReadAsTheBackgroundUnlessKept) {
  const LeafRow some = row_of({kNaN, 2});
  const LeafRow none = row_of({kNaN});
  for (const float background : {0.0F, 2.0F}) {
    const Fill replaced{FillMode::mean, background, NonFinitePolicy::background};
    EXPECT_EQ(replaced.exact(some, 8, 2), background == 2);
    EXPECT_TRUE(replaced.exact(none, 8, background));
    EXPECT_FALSE(replaced.exact(none, 8, 7));
    const Fill kept{FillMode::mean, background, NonFinitePolicy::keep};
    EXPECT_FALSE(kept.exact(some, 8, 2));
    EXPECT_FALSE(kept.exact(none, 8, background));
  }
}

}  // namespace
}  // namespace weir::fill_test
