#include "compressor/select/tree_plan.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/compressor/support/surveyed.h"

namespace weir::tree_plan_test {
namespace {

using test::Choice;
using test::Chooser;
using test::MemoryVolume;
using test::Surveyed;

float value_at(const Index3& i) { return static_cast<float>((i.x * 7 + i.y * 3 + i.z * i.z) % 101); }

TEST(TreePlan, NumbersNodesAndLeavesInFileOrder) {
  // Four upper nodes with several regions each.
  MemoryVolume volume({{-140, 4090, 0}, {130, 4100, 9}}, value_at);
  const Surveyed surveyed(volume);
  Chooser chooser(surveyed, GainRule{});
  const Choice choice = chooser.choose(chooser.lossless() - 40 * 2144);
  const TreeRegions& tree = chooser.tree();
  std::uint64_t upper = 0;
  std::uint64_t lower = 0;
  std::uint64_t leaf = 0;
  tree.for_each_upper([&](std::int64_t u) {
    if (!tree.uppers[static_cast<std::size_t>(u)].open) return;
    EXPECT_EQ(tree.uppers[static_cast<std::size_t>(u)].node, upper++);
    tree.for_each_region_of(u, [&](std::int64_t r) {
      const Region& region = tree.regions[static_cast<std::size_t>(r)];
      if (!region.open) return;
      EXPECT_EQ(region.node, lower++);
      EXPECT_EQ(region.first_leaf, leaf);
      leaf += region.leaves;
    });
  });
  const NodeCounts& counts = choice.plan.layout.counts;
  EXPECT_EQ(counts.uppers, upper);
  EXPECT_EQ(counts.lowers, lower);
  EXPECT_EQ(counts.leaves, leaf);
  EXPECT_EQ(counts.leaf_bytes, leaf * 2144);
  EXPECT_EQ(counts.root_tiles, tree.uppers.size());
  EXPECT_EQ(counts.leaves, static_cast<std::uint64_t>(std::count(choice.kept.begin(), choice.kept.end(), true)));
  EXPECT_EQ(counts.macrocells, 18U * 2 * 1);
}

TEST(TreePlan, UnusedBudgetIsLessThanOneNodeAndLeaf) {
  MemoryVolume volume({{0, 0, 0}, {300, 140, 40}}, value_at);
  const Surveyed surveyed(volume);
  Chooser chooser(surveyed, GainRule{});
  for (std::uint64_t size = chooser.minimum(); size < chooser.lossless(); size += 123'457) {
    const std::uint64_t end = chooser.choose(size).plan.layout.content_end;
    EXPECT_LE(end, size);
    EXPECT_LT(size - end, 33856U + 2144);
  }
}

}  // namespace
}  // namespace weir::tree_plan_test
