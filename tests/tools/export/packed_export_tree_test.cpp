#include "tools/export/packed_export_tree.h"

#include <gtest/gtest.h>

#include <bit>

#include "tests/support/packed_sample.h"

namespace weir::packed_export_tree_test {
namespace {

using test::PackedSample;

class PackedExportTree : public testing::Test {
 protected:
  test::PackedFile made_ = PackedSample::build();
  NvdbGrid grid_ = NvdbGrid::open(made_.file, "a.nvdb");
};

template <typename Mask>
int count(const Mask& mask) {
  int bits = 0;
  for (const std::uint64_t word : mask) bits += std::popcount(word);
  return bits;
}

TEST_F(PackedExportTree, Nodes_CoverTheDomainAlone) {
  const auto tree = make_packed_export_tree(grid_);
  const auto roots = tree->roots();
  ASSERT_EQ(roots.size(), 2U);
  UpperNode upper;
  tree->read_upper(roots[1].upper, upper);
  EXPECT_EQ(roots[1].origin, (Index3{0, 0, 0}));
  EXPECT_EQ(count(upper.children), 3);
  EXPECT_EQ(count(upper.active), 0);  // all three children reach beyond the domain
  LowerNode lower;
  const ExportNode second = tree->lower_of(roots[1].upper, 32 * 32);
  EXPECT_EQ(second.origin, (Index3{128, 0, 0}));
  tree->read_lower(second, lower);
  EXPECT_EQ(count(lower.children) + count(lower.active), 16 * 5 * 7);
  const auto has_leaf = [&](const Index3& block) {
    const unsigned entry = packed_position(block);
    return (lower.children[entry / 64] >> entry % 64 & 1U) != 0;
  };
  EXPECT_TRUE(has_leaf({17, 1, 3}));  // raw
  EXPECT_EQ(PackedSample::kind({17, 1, 5}), 2);
  EXPECT_FALSE(has_leaf({17, 1, 5}));  // a tile
  EXPECT_EQ(PackedSample::kind({17, 0, 3}), 2);
  EXPECT_TRUE(has_leaf({17, 0, 3}));  // a leaf, because the block reaches beyond the domain
  EXPECT_EQ(lower.values[packed_position({17, 1, 5})], PackedSample::value({17 * 8, 8, 40}));
}

TEST_F(PackedExportTree, Leaves_OutsideTheDomain_AreInactiveBackground) {
  const auto tree = make_packed_export_tree(grid_);
  const ExportNode leaf{nullptr, {-8, 0, 8}};
  EXPECT_EQ(count(tree->leaf_mask(leaf)), 5 * 5 * 6);
  std::array<float, kLeafVoxels> values;
  tree->read_leaf(leaf, values);
  for (std::int64_t n = 0; n < kLeafVoxels; ++n) {
    const Index3 i = leaf.origin + Index3{n >> 6, n >> 3 & 7, n & 7};
    EXPECT_EQ(values[static_cast<std::size_t>(n)], PackedSample::value(i));
  }
}

}  // namespace
}  // namespace weir::packed_export_tree_test
