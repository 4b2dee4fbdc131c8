#include "format/leaf/leaf_codec.h"

#include <gtest/gtest.h>
#include <nanovdb/NanoVDB.h>

#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

namespace weir::leaf_codec_test {
namespace {

using StockLeaf = nanovdb::NanoLeaf<float>;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

struct alignas(32) LeafImage {
  std::array<std::byte, nvdb::kFloatLeafBytes> bytes;
};

// A dense block around a leaf, of values that say where they are.
std::vector<float> block_values(const Box& box) {
  std::vector<float> values;
  for (std::int64_t n = 0; n < box.voxels(); ++n) {
    const Index3 i = box.lo + index_at(n, box.extent());
    values.push_back(static_cast<float>(i.x) + 0.01F * static_cast<float>(i.y) + 100 * static_cast<float>(i.z));
  }
  return values;
}

const Box kNode{{-8, 16, 120}, {0, 24, 128}};

std::vector<Box> insides() {
  return {kNode,
          {{-8, 16, 120}, {-7, 17, 121}},
          {{-1, 23, 127}, {0, 24, 128}},
          {{-8, 16, 120}, {0, 24, 125}},
          {{-5, 18, 120}, {-2, 24, 128}},
          {{-8, 20, 123}, {0, 21, 124}}};
}

TEST(LeafCodec, GathersTheVoxelsInsideAndFillsTheRest) {
  for (const Box& inside : insides()) {
    for (const std::int64_t margin : {0, 3, 11}) {
      const Box block{inside.lo - Index3{margin, 0, margin}, inside.hi + Index3{2 * margin, margin, 0}};
      LeafValues leaf;
      gather_leaf(block_values(block), block, kNode, inside, -77, leaf);
      for (std::int64_t n = 0; n < 512; ++n) {
        const Index3 i = kNode.lo + Index3{n >> 6, n >> 3 & 7, n & 7};
        const float expected = inside.contains(i) ? block_values({i, i + Index3{1, 1, 1}})[0] : -77;
        ASSERT_EQ(leaf[static_cast<std::size_t>(n)], expected);
      }
    }
  }
}

TEST(LeafCodec, NanoVdbReadsAnEncodedLeaf) {
  for (const Box& inside : insides()) {
    LeafValues leaf;
    gather_leaf(block_values(inside), inside, kNode, inside, 5, leaf);
    const NodeStatistics statistics = leaf_statistics(leaf, kNode, inside);
    LeafImage image;
    image.bytes.fill(std::byte{0xEE});
    encode_float_leaf(leaf, kNode, inside, statistics, image.bytes);
    static_assert(sizeof(StockLeaf) == nvdb::kFloatLeafBytes);
    const auto& stock = *reinterpret_cast<const StockLeaf*>(image.bytes.data());
    for (unsigned n = 0; n < 512; ++n) {
      const Index3 i = kNode.lo + Index3{n >> 6U, n >> 3U & 7U, n & 7U};
      ASSERT_EQ(stock.getValue(n), leaf[n]);
      ASSERT_EQ(stock.valueMask().isOn(n), inside.contains(i));
    }
    EXPECT_EQ(stock.origin(), nanovdb::Coord(-8, 16, 120));
    const nanovdb::CoordBBox box = stock.bbox();
    EXPECT_EQ(box.min(), nanovdb::Coord(static_cast<int>(inside.lo.x), static_cast<int>(inside.lo.y),
                                        static_cast<int>(inside.lo.z)));
    EXPECT_EQ(box.max(), nanovdb::Coord(static_cast<int>(inside.hi.x) - 1, static_cast<int>(inside.hi.y) - 1,
                                        static_cast<int>(inside.hi.z) - 1));
    EXPECT_TRUE(stock.hasBBox());
    EXPECT_EQ(stock.minimum(), statistics.min);
    EXPECT_EQ(stock.maximum(), statistics.max);
    EXPECT_EQ(stock.average(), statistics.average());
    EXPECT_EQ(stock.stdDeviation(), statistics.deviation());
    EXPECT_EQ(statistics.count, static_cast<std::uint64_t>(inside.voxels()));
    EXPECT_EQ(statistics.bbox, inside);
  }
}

TEST(LeafCodec, KeepsEveryBit) {
  LeafValues leaf;
  std::mt19937 random(8);
  for (float& v : leaf) v = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
  leaf[0] = -0.0F;
  leaf[511] = kNaN;
  LeafImage image;
  encode_float_leaf(leaf, kNode, kNode, leaf_statistics(leaf, kNode, kNode), image.bytes);
  EXPECT_EQ(std::memcmp(image.bytes.data() + nvdb::leaf::kValues, leaf.data(), sizeof leaf), 0);
}

TEST(LeafCodec, BatchedStatisticsEqualThoseOfSingleLeaves) {
  std::mt19937 random(10);
  for (std::size_t count = 0; count <= kLeafBatch; ++count) {
    std::vector<LeafValues> leaves(count);
    std::vector<Box> nodes;
    for (std::size_t l = 0; l < count; ++l) {
      const Index3 lo = Index3{static_cast<std::int64_t>(l), 2, -3} * 8;
      nodes.push_back({lo, lo + Index3{8, 8, 8}});
      for (float& v : leaves[l]) v = static_cast<float>(random()) * (l == 2 ? 1e28F : 1e-3F) - 1000;
      if (l == 1) leaves[l].fill(-0.0F);
      if (l == 3) leaves[l][100] = kNaN;
      if (l == 4) leaves[l].fill(kNaN);
      if (l == 5) leaves[l][0] = std::numeric_limits<float>::infinity();
      if (l == 6) {  // of the NaN that infinite values lead to and that beside, the same one is taken
        leaves[l][164] = std::numeric_limits<float>::infinity();
        leaves[l][165] = kNaN;
      }
    }
    std::vector<NodeStatistics> found(count);
    full_leaf_statistics(leaves, nodes, found);
    for (std::size_t l = 0; l < count; ++l) {
      const NodeStatistics expected = leaf_statistics(leaves[l], nodes[l], nodes[l]);
      EXPECT_EQ(std::bit_cast<std::uint32_t>(found[l].min), std::bit_cast<std::uint32_t>(expected.min)) << l;
      EXPECT_EQ(std::bit_cast<std::uint32_t>(found[l].max), std::bit_cast<std::uint32_t>(expected.max)) << l;
      EXPECT_EQ(std::bit_cast<std::uint64_t>(found[l].mean), std::bit_cast<std::uint64_t>(expected.mean)) << l;
      EXPECT_EQ(std::bit_cast<std::uint64_t>(found[l].m2), std::bit_cast<std::uint64_t>(expected.m2)) << l;
      EXPECT_EQ(found[l].count, expected.count);
      EXPECT_EQ(found[l].bbox, expected.bbox);
    }
  }
}

}  // namespace
}  // namespace weir::leaf_codec_test
