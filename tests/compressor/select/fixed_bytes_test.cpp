#include "compressor/select/fixed_bytes.h"

#include <gtest/gtest.h>

#include "format/layout/nanovdb_layout.h"

namespace weir::fixed_bytes_test {
namespace {

TEST(FixedBytes, OfATree_GrowWithItsNodesAndMacrocells) {
  const auto of_tree = [](const Box& domain, std::uint64_t regions) {
    return fixed_bytes(domain, Encoding::fpn, Preview::automatic, 0, regions);
  };
  const Box one{{0, 0, 0}, {128, 128, 128}};
  const Box two{{0, 0, 0}, {256, 128, 128}};
  EXPECT_EQ(of_tree(two, 2) - of_tree(two, 1), nvdb::kLowerBytes);
  EXPECT_EQ(of_tree(two, 1) - of_tree(one, 1), 512 * 8);  // 16^3 voxels a cell, two floats each
}

TEST(FixedBytes, Preview_IsThereWhereItIsATenthOfTheFile) {
  const Box domain{{0, 0, 0}, {512, 512, 512}};
  EXPECT_EQ(region_count(domain), 64U);
  const auto packed = [&](Preview preview, std::uint64_t asked) {
    return fixed_bytes(domain, Encoding::packed, preview, asked, 64);
  };
  const std::uint64_t on = packed(Preview::on, 0);
  const std::uint64_t off = packed(Preview::off, 0);
  EXPECT_GT(on, off + 64 * nvdb::kLowerBytes);
  EXPECT_EQ(packed(Preview::automatic, 10 * (on - off)), on);
  EXPECT_EQ(packed(Preview::automatic, 10 * (on - off) - 1), off);
}

}  // namespace
}  // namespace weir::fixed_bytes_test
