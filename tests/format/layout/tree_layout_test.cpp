#include "format/layout/tree_layout.h"

#include <gtest/gtest.h>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir::tree_layout_test {
namespace {

TEST(TreeLayout, PartsAreContiguousInFileOrder) {
  const TreeLayout layout = make_layout({3, 2, 5, 7, 7 * 2144, 11});
  EXPECT_EQ(layout.grid, 4096U);
  EXPECT_EQ(layout.uppers, 4096U + 672 + 64 + 64 + 3 * 32);
  EXPECT_EQ(layout.lowers, layout.uppers + 2 * 270400);
  EXPECT_EQ(layout.leaves, layout.lowers + 5 * 33856);
  EXPECT_EQ(layout.blind_meta, layout.leaves + 7 * 2144);
  EXPECT_EQ(layout.blind_data, layout.blind_meta + 288);
  EXPECT_EQ(layout.content_end, layout.blind_data + 96);  // 88 bytes of macrocells, up to the next 32
  EXPECT_EQ(layout.file_bytes, layout.content_end);
  EXPECT_EQ(layout.grid_bytes(), layout.file_bytes - 4096);
  EXPECT_EQ(layout.upper_offset(1), layout.uppers + 270400);
  EXPECT_EQ(layout.lower_offset(4), layout.leaves - 33856);
}

TEST(TreeLayout, OffsetsAreAlignedTo32Bytes) {
  for (std::uint64_t cells = 1; cells < 20; ++cells) {
    const TreeLayout layout = make_layout({cells, 1, cells, cells, cells * 352, cells});
    for (const std::uint64_t offset :
         {layout.uppers, layout.lowers, layout.leaves, layout.blind_meta, layout.blind_data, layout.content_end}) {
      EXPECT_EQ(offset % 32, 0U);
    }
    EXPECT_GE(layout.content_end, layout.blind_data + cells * 8);
    EXPECT_LT(layout.content_end, layout.blind_data + cells * 8 + 32);
  }
}

TEST(TreeLayout, OffsetsPass32Bits) {
  const std::uint64_t leaves = 0xFFFFFFFFULL;
  const TreeLayout layout = make_layout({1, 1, 1'048'576, leaves, leaves * 2144, 0});
  EXPECT_EQ(layout.blind_meta, 4096U + 832 + 270400 + 1'048'576ULL * 33856 + leaves * 2144);
}

// 13,001^3 voxels have more than 2^32 leaves: what all of them take is asked for any budget.
TEST(TreeLayout, MoreLeavesThanNanoVdbCounts_HaveALayout) {
  const std::uint64_t leaves = 1626ULL * 1626 * 1626;
  EXPECT_EQ(make_layout({1, 1, 1, leaves, leaves * 2144, 0}).blind_meta, 4096U + 832 + 270400 + 33856 + leaves * 2144);
}

TEST(TreeLayout, MoreLeavesOrTilesThanNanoVdbCounts_AreNoFile) {
  NodeCounts counts{1, 1, 1, 0xFFFFFFFFULL, 0, 0, 0xFFFFFFFFULL};
  EXPECT_TRUE(countable(counts));
  check_countable(counts, "out.nvdb");
  for (std::uint64_t NodeCounts::*count : {&NodeCounts::leaves, &NodeCounts::leaf_tiles}) {
    NodeCounts more{1, 1, 1, 5, 0, 0, 5};
    more.*count = 0x100000000ULL;
    EXPECT_FALSE(countable(more));
    try {
      check_countable(more, "out.nvdb");
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::budget);
      EXPECT_EQ(error.what(), cat("out.nvdb: the grid would have ", more.leaves, " leaves and ", more.leaf_tiles,
                                  " tiles of 8^3 voxels, NanoVDB counts up to 4294967295 of each; ask for a smaller "
                                  "size or a larger error"));
    }
  }
}

TEST(TreeLayout, PaddingOfAnySizeIsAppended) {
  const TreeLayout layout = make_layout({1, 1, 1, 2, 2 * 2144, 1});
  for (const std::uint64_t more : {0U, 1U, 31U, 33U, 1'000'003U}) {
    const TreeLayout padded = padded_to(layout, layout.content_end + more);
    EXPECT_EQ(padded.file_bytes, layout.content_end + more);
    EXPECT_EQ(padded.content_end, layout.content_end);
    EXPECT_EQ(padded.grid_bytes(), layout.grid_bytes() + more);
  }
  EXPECT_THROW(padded_to(layout, layout.content_end - 1), Error);
}

}  // namespace
}  // namespace weir::tree_layout_test
