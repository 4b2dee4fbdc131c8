#include "format/remote/request_plan.h"

#include <gtest/gtest.h>

namespace weir {
namespace {

std::vector<std::pair<std::uint64_t, std::uint64_t>> pairs(const std::vector<ByteRange>& ranges) {
  std::vector<std::pair<std::uint64_t, std::uint64_t>> all;
  for (const ByteRange& range : ranges) all.emplace_back(range.offset, range.end());
  return all;
}

using Pairs = std::vector<std::pair<std::uint64_t, std::uint64_t>>;

TEST(RequestPlan, JoinsWhatTouchesOrOverlaps) {
  EXPECT_EQ(pairs(plan_requests({{100, 50}, {0, 100}, {120, 10}}, 3)), (Pairs{{0, 150}}));
}

TEST(RequestPlan, ReadsGapsBelowTheShortest) {
  EXPECT_EQ(pairs(plan_requests({{0, 10}, {10 + kShortestGap - 1, 10}}, 2)), (Pairs{{0, 19 + kShortestGap}}));
  EXPECT_EQ(pairs(plan_requests({{0, 10}, {10 + kShortestGap, 10}}, 2)),
            (Pairs{{0, 10}, {10 + kShortestGap, 20 + kShortestGap}}));
}

TEST(RequestPlan, ReadsTheShortestGapsUntilThereAreFewEnough) {
  // Gaps of 5000, 9000, 7000 and 20000.
  const std::vector<ByteRange> wanted{{0, 1000}, {6000, 1000}, {16000, 1000}, {24000, 1000}, {45000, 1000}};
  EXPECT_EQ(pairs(plan_requests(wanted, 5)).size(), 5U);
  EXPECT_EQ(pairs(plan_requests(wanted, 3)), (Pairs{{0, 7000}, {16000, 25000}, {45000, 46000}}));
  EXPECT_EQ(pairs(plan_requests(wanted, 2)), (Pairs{{0, 25000}, {45000, 46000}}));
  EXPECT_EQ(pairs(plan_requests(wanted, 1)), (Pairs{{0, 46000}}));
}

TEST(RequestPlan, OfEqualGapsNeverAsksForMoreThanTheMost) {
  std::vector<ByteRange> wanted;
  for (std::uint64_t i = 0; i < 8; ++i) wanted.push_back({i * 10000, 2000});
  EXPECT_LE(plan_requests(wanted, 3).size(), 3U);
}

TEST(RequestPlan, LeavesEmptyRangesOut) {
  EXPECT_TRUE(plan_requests({{5, 0}, {9000, 0}}, 1).empty());
  EXPECT_EQ(pairs(plan_requests({{5, 0}, {9000, 1}}, 1)), (Pairs{{9000, 9001}}));
}

}  // namespace
}  // namespace weir
