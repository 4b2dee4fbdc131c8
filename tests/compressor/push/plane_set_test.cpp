#include "compressor/push/plane_set.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace weir::plane_set_test {
namespace {

using Ranges = std::vector<PlaneRange>;

TEST(PlaneSet, OverlappingRangeIsRefusedAndNotAdded) {
  PlaneSet planes;
  EXPECT_EQ(planes.add({4, 7}), std::nullopt);
  EXPECT_EQ(planes.add({9, 12}), std::nullopt);
  EXPECT_EQ(planes.add({0, 20}), (PlaneRange{4, 7}));
  EXPECT_EQ(planes.add({5, 6}), (PlaneRange{5, 6}));
  EXPECT_EQ(planes.add({6, 9}), (PlaneRange{6, 7}));
  EXPECT_EQ(planes.add({7, 10}), (PlaneRange{9, 10}));
  EXPECT_EQ(planes.add({11, 30}), (PlaneRange{11, 12}));
  EXPECT_EQ(planes.missing(20), (Ranges{{0, 4}, {7, 9}, {12, 20}}));
  EXPECT_EQ(planes.add({7, 9}), std::nullopt);
  EXPECT_EQ(planes.missing(12), (Ranges{{0, 4}}));
  EXPECT_EQ(planes.add({0, 4}), std::nullopt);
  EXPECT_EQ(planes.missing(12), Ranges{});
}

TEST(PlaneSet, RandomRangesAgreeWithASetOfPlanes) {
  std::mt19937 random(3);
  for (int run = 0; run < 200; ++run) {
    PlaneSet planes;
    std::set<std::int64_t> expected;
    for (int i = 0; i < 40; ++i) {
      const auto lo = static_cast<std::int64_t>(random() % 60);
      const auto hi = lo + 1 + static_cast<std::int64_t>(random() % 4);
      const auto twice = expected.lower_bound(lo);
      const bool refused = twice != expected.end() && *twice < hi;
      const auto answer = planes.add({lo, hi});
      ASSERT_EQ(answer.has_value(), refused);
      if (refused) {
        ASSERT_EQ(answer->lo, *twice);
        for (std::int64_t z = answer->lo; z < answer->hi; ++z) ASSERT_EQ(expected.count(z), 1U);
        ASSERT_TRUE(answer->hi == hi || expected.count(answer->hi) == 0);
      } else {
        for (std::int64_t z = lo; z < hi; ++z) expected.insert(z);
      }
    }
    std::set<std::int64_t> missing;
    for (const auto& [lo, hi] : planes.missing(64)) {
      for (std::int64_t z = lo; z < hi; ++z) missing.insert(z);
    }
    for (std::int64_t z = 0; z < 64; ++z) ASSERT_NE(missing.count(z), expected.count(z)) << z;
  }
}

TEST(PlaneSet, PlanesTextListsPlanesAndRanges) {
  EXPECT_EQ(planes_text({{7, 8}}), "plane 7");
  EXPECT_EQ(planes_text({{3, 6}}), "planes 3 to 5");
  EXPECT_EQ(planes_text({{3, 6}, {9, 10}}), "planes 3 to 5 and 9");
  EXPECT_EQ(planes_text({{0, 1}, {2, 3}, {4, 5}}), "planes 0, 2 and 4");
  EXPECT_EQ(planes_text({{0, 1}, {2, 3}, {4, 5}, {7, 8}, {10, 1030}}), "planes 0, 2, 4 and 1021 more");
}

}  // namespace
}  // namespace weir::plane_set_test
