#include "format/nanovdb/node_image.h"

#include <gtest/gtest.h>
#include <nanovdb/NanoVDB.h>

#include <cstring>
#include <vector>

namespace weir::node_image_test {
namespace {

// The image at NanoVDB's alignment, as its own node type.
template <typename Node>
class Stock {
 public:
  explicit Stock(std::span<const std::byte> bytes) : copy_(bytes.size() / sizeof(Block)) {
    std::memcpy(copy_.data(), bytes.data(), bytes.size());
  }
  const Node& node() const { return *reinterpret_cast<const Node*>(copy_.data()); }

 private:
  struct alignas(32) Block {
    std::byte bytes[32];
  };
  std::vector<Block> copy_;
};

template <typename Node>
void expect_entries(NodeImage::Level level, std::int64_t side) {
  NodeImage image(level, 0.25F);
  image.set_tile({1, 2, 3}, -7, true);
  image.set_tile({side - 1, 0, side - 2}, 9, false);
  image.set_child({0, side - 1, 5}, 0x123456789A0ULL);
  NodeStatistics statistics;
  statistics.add_tile(-7, 512, {{side * 8, 16, 24}, {side * 8 + 8, 24, 32}});
  image.set_statistics(statistics);
  ASSERT_EQ(image.bytes().size(), sizeof(Node));
  const Stock<Node> stock(image.bytes());
  const auto& data = *stock.node().data();
  const auto at = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
    return static_cast<std::uint32_t>((x * side + y) * side + z);
  };
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(side * side * side); ++i) {
    const bool child = i == at(0, side - 1, 5);
    ASSERT_EQ(data.mValueMask.isOn(i), i == at(1, 2, 3));
    ASSERT_EQ(data.mChildMask.isOn(i), child);
    if (child) {
      ASSERT_EQ(data.mTable[i].child, 0x123456789A0LL);
    } else {
      ASSERT_EQ(data.mTable[i].value, i == at(1, 2, 3) ? -7 : i == at(side - 1, 0, side - 2) ? 9 : 0.25F);
      ASSERT_EQ(data.mTable[i].child >> 32U, 0);
    }
  }
  EXPECT_EQ(data.mMinimum, -7);
  EXPECT_EQ(data.mMaximum, -7);
  EXPECT_EQ(data.mAverage, -7);
  EXPECT_EQ(data.mStdDevi, 0);
  EXPECT_EQ(data.mFlags, 2U);
  EXPECT_EQ(data.mBBox.min(), nanovdb::Coord(static_cast<int>(side) * 8, 16, 24));
  EXPECT_EQ(data.mBBox.max(), nanovdb::Coord(static_cast<int>(side) * 8 + 7, 23, 31));

  // Without active values: the box is inverted and a renderer may skip the node.
  image.reset();
  image.set_statistics({});
  const Stock<Node> empty(image.bytes());
  EXPECT_TRUE(empty.node().data()->mBBox.empty());
  EXPECT_EQ(empty.node().data()->mFlags, 1U);
  EXPECT_TRUE(empty.node().data()->mValueMask.isOff());
  EXPECT_TRUE(empty.node().data()->mChildMask.isOff());
  EXPECT_EQ(empty.node().data()->mTable[at(0, side - 1, 5)].value, 0.25F);
}

TEST(NodeImage, LowerNodeMatchesNanoVdb) { expect_entries<nanovdb::NanoLower<float>>(NodeImage::Level::lower, 16); }
TEST(NodeImage, UpperNodeMatchesNanoVdb) { expect_entries<nanovdb::NanoUpper<float>>(NodeImage::Level::upper, 32); }

}  // namespace
}  // namespace weir::node_image_test
