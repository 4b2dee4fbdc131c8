#include "format/base/box_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>
#include <random>
#include <set>
#include <tuple>
#include <vector>

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

// `whole` in blocks of `block`, those at its upper ends smaller, in a random order.
Boxes shuffled_blocks(const Box& whole, const Index3& block) {
  Boxes blocks;
  const Index3 e = whole.extent();
  for_each_index({{0, 0, 0}, {ceil_div(e.x, block.x), ceil_div(e.y, block.y), ceil_div(e.z, block.z)}},
                 [&](const Index3& i) {
                   const Index3 lo = whole.lo + Index3{i.x * block.x, i.y * block.y, i.z * block.z};
                   blocks.push_back({lo, min(lo + block, whole.hi)});
                 });
  std::shuffle(blocks.begin(), blocks.end(), std::minstd_rand(3));
  return blocks;
}

// So many that comparing each with all others would take minutes.
TEST(BoxCoverage, ManyBlocksInRandomOrder_TellWhatIsMissingOrRepeated) {
  const Box whole{{-3, 5, 100}, {317, 325, 417}};
  Boxes blocks = shuffled_blocks(whole, {5, 5, 5});
  ASSERT_EQ(blocks.size(), 262144U);
  Coverage found = coverage_of(whole, blocks);
  EXPECT_EQ(found.repeated, std::nullopt);
  EXPECT_EQ(found.missing, Boxes{});

  const Box last = blocks.back();
  blocks.pop_back();
  found = coverage_of(whole, blocks);
  EXPECT_EQ(found.repeated, std::nullopt);
  EXPECT_EQ(found.missing, Boxes{last});

  blocks.push_back(blocks[1000]);
  blocks.push_back(blocks[2000]);
  EXPECT_EQ(coverage_of(whole, blocks).repeated, 262143U) << "the first of both";
}

TEST(BoxCoverage, RowsAndSlabsThatAreMissing_AreWholeBoxes) {
  const Box whole{{0, 0, 0}, {20, 30, 40}};
  Boxes blocks = shuffled_blocks(whole, {10, 10, 10});
  std::erase_if(blocks, [](const Box& box) { return box.lo.z == 30 || (box.lo.z == 10 && box.lo.y == 10); });
  EXPECT_EQ(coverage_of(whole, blocks).missing, (Boxes{{{0, 10, 10}, {20, 20, 20}}, {{0, 0, 30}, {20, 30, 40}}}));
  EXPECT_EQ(coverage_of(whole, {}).missing, Boxes{whole});
}

TEST(BoxCoverage, BoxesWithGhostLayers_RepeatWhatTheirNeighboursHave) {
  Boxes blocks = shuffled_blocks({{0, 0, 0}, {40, 40, 40}}, {4, 4, 4});
  std::ranges::sort(blocks, {}, [](const Box& box) { return std::tuple(box.lo.z, box.lo.y, box.lo.x); });
  for (Box& box : blocks) box.hi = box.hi + Index3{1, 1, 1};
  EXPECT_EQ(coverage_of({{0, 0, 0}, {41, 41, 41}}, blocks).repeated, 1U);
}

// Against a count for each position.
TEST(BoxCoverage, RandomBoxes_AgreeWithCountedPositions) {
  std::minstd_rand random(11);
  const auto below = [&](std::int64_t n) { return static_cast<std::int64_t>(random() % static_cast<unsigned>(n)); };
  constexpr Box kWhole{{0, 0, 0}, {7, 7, 7}};
  int disjoint = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    Boxes boxes;
    for (std::int64_t k = below(6); k >= 0; --k) {
      const Index3 lo{below(6), below(6), below(6)};
      boxes.push_back({lo, min(lo + Index3{1 + below(4), 1 + below(4), 1 + below(4)}, kWhole.hi)});
    }
    std::array<int, 343> times{};
    std::optional<std::size_t> repeated;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      for_each_index(boxes[i], [&](const Index3& at) {
        if (times[static_cast<std::size_t>(linear_index(at, kWhole.hi))]++ > 0 && !repeated) repeated = i;
      });
    }
    const Coverage found = coverage_of(kWhole, boxes);
    ASSERT_EQ(found.repeated, repeated) << trial;
    if (repeated) continue;
    ++disjoint;
    for (const Box& box : found.missing) {
      for_each_index(box, [&](const Index3& at) { ++times[static_cast<std::size_t>(linear_index(at, kWhole.hi))]; });
    }
    EXPECT_EQ(std::ranges::count(times, 1), std::ssize(times)) << trial;
  }
  EXPECT_GT(disjoint, 100);
}

}  // namespace
}  // namespace weir::box_set_test
