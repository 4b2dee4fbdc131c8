#include "format/base/box_set.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <tuple>

namespace weir::box_set_test {
namespace {

using Boxes = std::vector<Box>;

TEST(BoxSet, MergesBoxesThatShareAWholeSide) {
  BoxSet set;
  EXPECT_TRUE(set.empty());
  // A lattice of 4 x 4 x 4 in blocks of 2 x 2 x 2, in their order.
  std::size_t most = 0;
  for_each_index({{0, 0, 0}, {2, 2, 2}}, [&](const Index3& i) {
    set.add({i * 2, i * 2 + Index3{2, 2, 2}});
    most = std::max(most, set.boxes().size());
  });
  EXPECT_EQ(set.boxes(), (Boxes{{{0, 0, 0}, {4, 4, 4}}}));
  EXPECT_EQ(most, 3U);
  EXPECT_EQ(set.size(), 64);
  set.add({{0, 0, 4}, {2, 4, 5}});  // not a whole side
  EXPECT_EQ(set.boxes(), (Boxes{{{0, 0, 0}, {4, 4, 4}}, {{0, 0, 4}, {2, 4, 5}}}));
}

TEST(BoxSet, MissingFromGivesTheUncoveredBoxes) {
  BoxSet set;
  const Box all{{0, 0, 0}, {9, 8, 7}};
  EXPECT_EQ(set.missing_from(all), Boxes{all});
  set.add({{0, 0, 0}, {9, 8, 3}});
  EXPECT_EQ(set.missing_from({{1, 1, 1}, {2, 2, 3}}), Boxes{});
  EXPECT_EQ(set.missing_from(all), (Boxes{{{0, 0, 3}, {9, 8, 7}}}));
  set.add({{0, 0, 3}, {9, 2, 5}});
  EXPECT_EQ(set.missing_from(all), (Boxes{{{0, 2, 3}, {9, 8, 5}}, {{0, 0, 5}, {9, 8, 7}}}));
  BoxSet hole;
  hole.add({{1, 1, 1}, {2, 2, 2}});
  EXPECT_EQ(hole.missing_from({{0, 0, 0}, {3, 3, 3}}), (Boxes{{{0, 0, 0}, {3, 3, 1}},
                                                              {{0, 0, 1}, {3, 1, 2}},
                                                              {{0, 1, 1}, {1, 2, 2}},
                                                              {{2, 1, 1}, {3, 2, 2}},
                                                              {{0, 2, 1}, {3, 3, 2}},
                                                              {{0, 0, 2}, {3, 3, 3}}}));
}

TEST(BoxSet, RandomBoxesAgreeWithASetOfPositions) {
  std::minstd_rand random(7);
  const auto below = [&](std::int64_t n) { return static_cast<std::int64_t>(random() % static_cast<unsigned>(n)); };
  const auto any_box = [&] {
    const Index3 lo{below(5), below(5), below(5)};
    return Box{lo, lo + Index3{1 + below(4), 1 + below(4), 1 + below(4)}};
  };
  using Position = std::tuple<std::int64_t, std::int64_t, std::int64_t>;
  for (int trial = 0; trial < 200; ++trial) {
    BoxSet set;
    std::set<Position> expected;
    const auto insert = [](std::set<Position>& into, const Box& box) {
      for_each_index(box, [&](const Index3& i) { EXPECT_TRUE(into.emplace(i.x, i.y, i.z).second) << "twice"; });
    };
    for (int k = 0; k < 6; ++k) {
      for (const Box& part : set.missing_from(any_box())) {
        insert(expected, part);
        set.add(part);
      }
    }
    EXPECT_EQ(set.size(), static_cast<std::int64_t>(expected.size()));
    const Box all{{0, 0, 0}, {9, 9, 9}};
    for (const Box& part : set.missing_from(all)) insert(expected, part);
    EXPECT_EQ(expected.size(), 729U);
  }
}

}  // namespace
}  // namespace weir::box_set_test
