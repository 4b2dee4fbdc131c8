// The turns of a brick cache, on the host: requested bricks come in, unused bricks go, and bricks have the voxels
// that file readers get.
#include "gpu/cuda/bricks/brick_pager.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>

#include "gpu/cuda/bricks/brick_position.h"
#include "gpu/cuda/bricks/fixed_positions.h"
#include "gpu/math/random.h"
#include "tests/gpu/bricks/brick_pager_fixture.h"

namespace weir::brick_pager_test {
namespace {

using test::BrickPagerTest;
using test::Cache;
using test::look_up;

TEST_F(BrickPagerTest, AllBricksTogetherHoldAllVoxelsAndThoseNextAbove) {
  Cache<float> floats(*grid_, plan(3, 2000));
  Cache<std::uint16_t> words(*grid_, plan(3, 2000));
  const std::uint32_t missing = floats.pager.bring_all_pages();
  EXPECT_EQ(words.pager.bring_all_pages(), missing);
  EXPECT_GT(missing, 1000U);
  EXPECT_TRUE(floats.pager.bring_all_bricks());
  EXPECT_TRUE(words.pager.bring_all_bricks());
  EXPECT_EQ(floats.pager.counters().built, missing);
  EXPECT_GT(floats.pager.counters().decoded, missing / 2);
  std::uint32_t bricks = 0;
  for_each_block([&](const Int3& block) {
    const BrickEntry entry = floats.pager.table().find(block);
    ASSERT_EQ(entry.state & brick_state::kMissing, 0U);
    bricks += entry.brick == 0 ? 0 : 1;
    ASSERT_EQ(difference(floats, entry, block), 0);
    ASSERT_LE(difference(words, words.pager.table().find(block), block), 0.51 / 65535);
  });
  EXPECT_EQ(floats.pager.counters().free_slots, 2000 - bricks);
  EXPECT_EQ(words.pager.counters().free_slots, 2000 - bricks);
}

TEST_F(BrickPagerTest, BlocksOfOneValueTakeNoSlot) {
  test::PackedGridOptions options;
  options.domain = {{-40, 0, 0}, {300, 64, 64}};
  options.stream = [](const Index3& block) -> test::PackedBytes {
    if (block.x >= 2) return {};
    if (block.x < 0) return test::constant_stream(3.5F);
    std::array<float, 512> values;
    for (std::size_t i = 0; i < 512; ++i) values[i] = static_cast<float>(i % 77);
    return test::raw_stream(values);
  };
  options.value = [](const Index3&) { return 1.25F; };
  open(test::PackedGridBuilder::build(options));
  Cache<std::uint16_t> cache(*grid_, plan(4, 1000));
  EXPECT_EQ(cache.pager.bring_all_pages(), 7 * 64U);
  EXPECT_TRUE(cache.pager.bring_all_bricks());
  EXPECT_EQ(cache.pager.counters().free_slots, 1000 - 3 * 64U) << "two layers and the one whose upper voxels differ";
  for_each_block(
      [&](const Int3& block) { ASSERT_LE(difference(cache, cache.pager.table().find(block), block), 0.51 / 65535); });
}

// As the texture unit counts: a voxel's centre is half a texel up, and positions are in steps of 1/256.
TEST_F(BrickPagerTest, ATableOfAllBricksNamesThePlaceOfEveryPosition) {
  Cache<float> cache(*grid_, plan(3, 2000));
  cache.pager.bring_all_pages();
  ASSERT_TRUE(cache.pager.bring_all_bricks());
  const auto entries = cache.pager.take_table();
  const BrickTable table(lattice_, entries.data());
  Random random(1, 2, 3);
  for (int n = 0; n < 20000; ++n) {
    const Float3 q{random.uniform() * 210 - 3, random.uniform() * 60 - 2, random.uniform() * 54 - 1};
    const BrickTable::Position at = table.position(q);
    const BrickEntry& entry = entries.data()[table.index(at)];
    ASSERT_NE(entry.brick, 0U);
    const Float3 found = BrickTable::texel(entry, at);
    const BrickPosition paged(lattice_, q);
    ASSERT_EQ(paged.texel(entry), found) << "in a cache, too";
    const FixedPositions fixed(lattice_);
    const FixedPositions::Position near = fixed.at(q);
    ASSERT_EQ(FixedPositions::texel(entry, near), found);
    ASSERT_EQ(fixed.region(near), lattice_.region_of(paged.block));
    ASSERT_EQ(FixedPositions::in_region(near), BlockLattice::position_of(paged.block));
    ASSERT_EQ(entries
                  .data()[table_index({paged.block.x - (lattice_.shift.x >> 3), paged.block.y - (lattice_.shift.y >> 3),
                                       paged.block.z - (lattice_.shift.z >> 3)},
                                      BrickTable::blocks(lattice_))]
                  .brick,
              entry.brick);
    const Int3 corner = entry.corner();
    // The voxel that the position is at or above.
    const Float3 f{found.x - 0.5F, found.y - 0.5F, found.z - 0.5F};
    const Int3 v{static_cast<std::int32_t>(f.x), static_cast<std::int32_t>(f.y), static_cast<std::int32_t>(f.z)};
    const Int3 in_brick{v.x - corner.x, v.y - corner.y, v.z - corner.z};
    ASSERT_TRUE(in_brick.x >= 0 && in_brick.x < 8 && in_brick.y >= 0 && in_brick.y < 8 && in_brick.z >= 0 &&
                in_brick.z < 8);
    const auto expected = [](float p, std::int32_t extent) {
      return std::nearbyint(256 * std::clamp(p, 0.0F, static_cast<float>(extent - 1))) / 256;
    };
    const Float3 e{expected(q.x, lattice_.extent.x), expected(q.y, lattice_.extent.y),
                   expected(q.z, lattice_.extent.z)};
    const Int3 i{static_cast<std::int32_t>(e.x), static_cast<std::int32_t>(e.y), static_cast<std::int32_t>(e.z)};
    ASSERT_EQ(f.x - static_cast<float>(v.x), e.x - static_cast<float>(i.x)) << q.x;
    ASSERT_EQ(f.y - static_cast<float>(v.y), e.y - static_cast<float>(i.y)) << q.y;
    ASSERT_EQ(f.z - static_cast<float>(v.z), e.z - static_cast<float>(i.z)) << q.z;
    ASSERT_EQ(cache.texel(entry, in_brick), leaves_->view().voxel(i));
  }
}

TEST_F(BrickPagerTest, FixedPositionsReachTheLastVoxelOfTheLargestDomainTheyTake) {
  constexpr std::int32_t kMost = FixedPositions::kMost;
  const BlockLattice largest{{kMost / 128 + 2, kMost / 128 + 2, 1}, {127, 5, 0}, {kMost, kMost, 8}};
  const FixedPositions fixed(largest);
  const BrickEntry entry{0, 1, 5, 0};
  for (const float x : {0.0F, 0.25F, 100.625F, 8191.5F, kMost - 1.0F}) {
    const Float3 q{x, kMost - 2.0F - x, 3.5F};
    const FixedPositions::Position at = fixed.at(q);
    const BrickPosition wide(largest, q);
    EXPECT_EQ(fixed.region(at), largest.region_of(wide.block)) << x;
    EXPECT_EQ(FixedPositions::in_region(at), BlockLattice::position_of(wide.block)) << x;
    EXPECT_EQ(FixedPositions::texel(entry, at), wide.texel(entry)) << x;
  }
}

TEST_F(BrickPagerTest, PositionsOfTheLongestDomainsStayInTheirBlocks) {
  const BlockLattice longest{{(1 << 23) + 1, 1, 1}, {127, 0, 0}, {1 << 30, 8, 8}};
  for (const float q : {0.0F, 16256.996F, 16777217.0F, 1073741824.0F, 2e9F}) {
    const BrickPosition at(longest, {q, 3.4F, 9});
    EXPECT_GE(at.block.x, 15);
    EXPECT_LE(at.block.x, longest.last_block().x) << q;
    EXPECT_LT(at.in_block.x, 8);
    EXPECT_EQ(at.block.y, 0);
    EXPECT_EQ(at.in_block.z, 7);
    EXPECT_EQ(at.in_block.y, std::nearbyint(256 * 3.4F) / 256);
  }
}

TEST_F(BrickPagerTest, BricksThat16BitsDoNotHoldAreCounted) {
  for (const float odd : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e-42F}) {
    test::PackedGridOptions options;
    options.domain = {{0, 0, 0}, {32, 32, 32}};
    options.stream = [odd](const Index3& block) {
      std::array<float, 512> values{};
      if (block == Index3{1, 2, 1}) values[77] = odd;
      return test::raw_stream(values);
    };
    open(test::PackedGridBuilder::build(options));
    Cache<std::uint16_t> words(*grid_, plan(1, 100));
    EXPECT_EQ(words.pager.bring_all_pages(), 64U);
    EXPECT_FALSE(words.pager.bring_all_bricks()) << odd;
    EXPECT_EQ(words.pager.counters().unfit, 1U) << odd;
    Cache<std::uint16_t> some(*grid_, plan(1, 100));
    bool seen = false;
    for (int turn = 0; turn < 4 && !seen; ++turn) {
      EXPECT_NE(some.pager.table().find_or_request({1, 2, 1}).state & brick_state::kMissing, 0U)
          << "never a wrong value";
      seen = some.pager.serve().unfit;
    }
    EXPECT_TRUE(seen);
    Cache<float> floats(*grid_, plan(1, 100));
    floats.pager.bring_all_pages();
    EXPECT_TRUE(floats.pager.bring_all_bricks()) << odd;
    const BrickEntry entry = floats.pager.table().find({1, 2, 1});
    const float found = floats.texel(entry, {77 >> 6, 77 >> 3 & 7, 77 & 7});
    EXPECT_TRUE(found == odd || (std::isnan(odd) && std::isnan(found))) << odd;
  }
}

TEST_F(BrickPagerTest, WhatIsAskedForComesInAndWhatWasUsedLongestAgoGoes) {
  Cache<float> cache(*grid_, plan(3, 300));
  std::vector<Int3> all;
  for_each_block([&](const Int3& block) { all.push_back(block); });
  const auto right = [&](const BrickEntry& entry, const Int3& block) {
    ASSERT_EQ(difference(cache, entry, block), 0) << block.x << ' ' << block.y << ' ' << block.z;
  };
  const auto stretch = [&](std::size_t first) {
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first);
    return std::vector<Int3>(begin, begin + 140);
  };
  const std::vector<Int3> a = stretch(0);
  const std::vector<Int3> b = stretch(400);
  const std::vector<Int3> c = stretch(800);

  EXPECT_EQ(look_up(cache, right, a), 0U) << "its pages are not there";
  PagingTurn turn = cache.pager.serve();
  EXPECT_GE(turn.pages, 1U);
  EXPECT_EQ(turn.bricks, 0U);
  const std::size_t uniform = look_up(cache, right, a);
  EXPECT_LT(uniform, 40U);
  turn = cache.pager.serve();
  EXPECT_EQ(turn.bricks, 140 - uniform);
  EXPECT_FALSE(turn.crowded());
  EXPECT_EQ(look_up(cache, right, a), 140U);
  turn = cache.pager.serve();
  EXPECT_EQ(turn.asked_bricks + turn.asked_pages, 0U);

  for (const auto& blocks : {b, c}) {
    for (int i = 0; i < 2; ++i) {
      look_up(cache, right, blocks);
      cache.pager.serve();
    }
    EXPECT_EQ(look_up(cache, right, blocks), 140U);
    cache.pager.serve();
  }
  EXPECT_EQ(look_up(cache, right, b), 140U) << "only a had to go";
  EXPECT_LT(look_up(cache, right, a), 60U);
}

// Drafts use the middle of the range until the brick is there again.
TEST_F(BrickPagerTest, WhereABrickHadToGoIsTheMiddleOfItsRange) {
  const auto expect_middles = [&](auto& cache, float tolerance) {
    std::vector<Int3> all;
    for_each_block([&](const Int3& block) { all.push_back(block); });
    const auto ignore = [](const BrickEntry&, const Int3&) {};
    const std::vector<Int3> first(all.begin(), all.begin() + 90);
    const std::vector<Int3> others(all.begin() + 500, all.begin() + 600);
    for (const auto& blocks : {first, others}) {
      for (int i = 0; i < 4; ++i) {
        look_up(cache, ignore, blocks);
        cache.pager.serve();
      }
    }
    int gone = 0;
    for (const Int3& block : first) {
      const BrickEntry entry = cache.pager.table().find(block);
      if ((entry.state & brick_state::kMissing) == 0) continue;
      ++gone;
      MinMax range{kInfinity, -kInfinity};
      for (std::int32_t n = 0; n < kBrickTexels; ++n) {
        const float v = voxel({8 * block.x + n / (kBrickEdge * kBrickEdge), 8 * block.y + n / kBrickEdge % kBrickEdge,
                               8 * block.z + n % kBrickEdge});
        range = {lesser(range.min, v), greater(range.max, v)};
      }
      ASSERT_NEAR(entry.low, 0.5F * range.min + 0.5F * range.max, tolerance * (range.max - range.min));
    }
    EXPECT_GT(gone, 30);
  };
  Cache<float> floats(*grid_, plan(3, 120));
  expect_middles(floats, 1e-6F);
  Cache<std::uint16_t> words(*grid_, plan(3, 120));
  expect_middles(words, 1e-4F);
}

TEST_F(BrickPagerTest, MoreThanTheCacheHoldsIsServedInPart) {
  Cache<float> cache(*grid_, plan(3, 100));
  std::vector<Int3> all;
  for_each_block([&](const Int3& block) { all.push_back(block); });
  const auto ignore = [](const BrickEntry&, const Int3&) {};
  look_up(cache, ignore, all);
  cache.pager.serve();
  look_up(cache, ignore, all);
  const PagingTurn turn = cache.pager.serve();
  EXPECT_TRUE(turn.crowded());
  EXPECT_EQ(turn.bricks, 100U);
  EXPECT_GT(turn.asked_bricks, 1000U);

  // Everything in the cache was used, so nothing is evicted. When fewer blocks are looked up, their bricks come.
  look_up(cache, ignore, all);
  EXPECT_EQ(cache.pager.serve().bricks, 0U);
  const std::vector<Int3> few(all.end() - 50, all.end());
  look_up(cache, ignore, few);
  cache.pager.serve();
  EXPECT_EQ(look_up(
                cache, [&](const BrickEntry& e, const Int3& b) { ASSERT_EQ(difference(cache, e, b), 0); }, few),
            50U);
}

TEST_F(BrickPagerTest, FewerPagesThanRegionsTakeTurns) {
  Cache<float> cache(*grid_, plan(1, 600));
  const auto right = [&](const BrickEntry& entry, const Int3& block) { ASSERT_EQ(difference(cache, entry, block), 0); };
  std::vector<std::vector<Int3>> by_region(3);
  for_each_block([&](const Int3& block) { by_region[lattice_.region_of(block)].push_back(block); });
  for (int round = 0; round < 2; ++round) {
    for (const std::vector<Int3>& region : by_region) {
      for (int i = 0; i < 3; ++i) {
        look_up(cache, right, {region.begin(), region.begin() + 8});
        cache.pager.serve();
      }
      EXPECT_EQ(look_up(cache, right, {region.begin(), region.begin() + 8}), 8U);
    }
  }
  // Both regions are requested and there is one page, so one region waits.
  std::vector<Int3> both{by_region[0].front(), by_region[1].front()};
  look_up(cache, right, both);
  EXPECT_TRUE(cache.pager.serve().crowded());
}

// Bricks of a dropped page are free and no longer counted as old.
TEST_F(BrickPagerTest, ATurnThatDropsAPageAndFillsAllSlotsCountsEachOnce) {
  Cache<float> cache(*grid_, plan(2, 100));
  const auto right = [&](const BrickEntry& entry, const Int3& block) { ASSERT_EQ(difference(cache, entry, block), 0); };
  std::vector<std::vector<Int3>> by_region(3);
  for_each_block([&](const Int3& block) { by_region[lattice_.region_of(block)].push_back(block); });
  const auto some = [&](std::size_t region, std::size_t first, std::size_t count) {
    const auto begin = by_region[region].begin() + static_cast<std::ptrdiff_t>(first);
    return std::vector<Int3>(begin, begin + static_cast<std::ptrdiff_t>(count));
  };
  for (int i = 0; i < 3; ++i) {  // region 2 fills 60 of 100 slots, then region 1 the others
    look_up(cache, right, some(2, 0, 60));
    cache.pager.serve();
  }
  for (int i = 0; i < 3; ++i) {
    look_up(cache, right, some(1, 0, 40));
    cache.pager.serve();
  }
  std::vector<Int3> all = some(1, 0, 120);
  all.push_back(by_region[0].front());
  look_up(cache, right, all);
  const PagingTurn turn = cache.pager.serve();
  EXPECT_EQ(turn.pages, 1U);
  EXPECT_EQ(turn.bricks, 60U) << "those that region 2 had; 40 are in use";
  EXPECT_EQ(look_up(cache, right, some(1, 0, 40)), 40U);
  cache.pager.serve();
  EXPECT_EQ(cache.pager.counters().free_slots, 0U);
}

TEST_F(BrickPagerTest, AFullListOfRequestsLosesNone) {
  BrickPlan few = plan(3, 2000);
  few.most_requests = 4096;
  few.blocks = 5000;
  Cache<float> whole(*grid_, few);
  whole.pager.bring_all_pages();
  EXPECT_TRUE(whole.pager.bring_all_bricks());
  few.most_requests = 50;
  Cache<float> cache(*grid_, few);
  std::vector<Int3> all;
  for_each_block([&](const Int3& block) { all.push_back(block); });
  const auto right = [&](const BrickEntry& entry, const Int3& block) { ASSERT_EQ(difference(cache, entry, block), 0); };
  std::size_t turns = 0;
  while (look_up(cache, right, all) < all.size()) {
    ASSERT_LE(cache.pager.serve().bricks, 50U);
    ASSERT_LT(++turns, 60U);
  }
  EXPECT_GT(turns, 25U);
}

}  // namespace
}  // namespace weir::brick_pager_test
