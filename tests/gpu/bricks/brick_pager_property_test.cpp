// For any look-ups and any small cache: the bricks that are there are right, and no slot is lost or has two owners.
#include <gtest/gtest.h>

#include <cstddef>
#include <random>
#include <set>
#include <vector>

#include "tests/gpu/bricks/brick_pager_fixture.h"

namespace weir::brick_pager_property_test {
namespace {

using test::Cache;
using test::look_up;

class BrickPagerProperty : public test::BrickPagerTest {
 protected:
  void expect_whole(Cache<float>& cache, const BrickPlan& plan, unsigned seed) const {
    const PageTable table = cache.pager.table();
    std::set<std::uint32_t> bricks;
    std::size_t owned = 0;
    for_each_block([&](const Int3& block) {
      const RegionEntry region = table.regions[table.lattice.region_of(block)];
      ASSERT_EQ(region.page & RegionEntry::kRequested, 0U) << seed;
      if (region.page == 0 || (region.page & RegionEntry::kMissing) != 0) return;
      const BrickEntry& entry = table.entry(region.page, block);
      ASSERT_EQ(entry.state & brick_state::kRequested, 0U) << seed;
      if (entry.brick == 0) return;
      bricks.insert(entry.brick);
      ++owned;
    });
    ASSERT_EQ(bricks.size(), owned) << "a slot has two owners, seed " << seed;
    cache.pager.check();
    ASSERT_EQ(owned + cache.pager.counters().free_slots, plan.slots) << seed;
  }
};

TEST_F(BrickPagerProperty, RandomLookUpsFindWhatIsRightAndLoseNoSlot) {
  std::vector<Int3> all;
  for_each_block([&](const Int3& block) { all.push_back(block); });
  std::size_t found = 0;
  std::size_t crowded = 0;
  std::size_t evicted = 0;
  for (unsigned seed = 0; seed < 24; ++seed) {
    std::mt19937 random(seed);
    const auto between = [&](std::uint32_t low, std::uint32_t high) {
      return low + static_cast<std::uint32_t>(random()) % (high - low + 1);
    };
    BrickPlan plan = BrickPagerTest::plan(between(1, 3), between(20, 600));
    plan.blocks = between(8, 400);
    plan.most_requests = between(10, 2000);
    Cache<float> cache(*grid_, plan);
    for (int turn = 0; turn < 25; ++turn) {
      // A few stretches of neighbouring blocks, as rays meet them.
      std::vector<Int3> blocks;
      for (std::uint32_t n = between(1, 6); n > 0; --n) {
        const std::size_t first = random() % all.size();
        for (std::size_t i = first; i < std::min(all.size(), first + between(1, 120)); ++i) blocks.push_back(all[i]);
      }
      for (int again = 0; again < 2; ++again) {
        found += look_up(
            cache,
            [&](const BrickEntry& entry, const Int3& block) {
              if (random() % 16 != 0) return;
              ASSERT_EQ(difference(cache, entry, block), 0) << seed << ' ' << turn;
            },
            blocks);
        const PagingTurn served = cache.pager.serve();
        crowded += served.crowded() ? 1 : 0;
        evicted += served.evicted;
        expect_whole(cache, plan, seed);
      }
    }
  }
  EXPECT_GT(found, 20000U);
  EXPECT_GT(crowded, 100U);
  EXPECT_GT(evicted, 1000U);
}

}  // namespace
}  // namespace weir::brick_pager_property_test
