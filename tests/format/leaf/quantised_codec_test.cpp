// Leaves read back by the stock leaf classes of NanoVDB.
#include "format/leaf/quantised_codec.h"

#include <gtest/gtest.h>
#include <nanovdb/NanoVDB.h>

#include <array>

#include "format/leaf/leaf_codec.h"
#include "format/leaf/leaf_decode.h"

namespace weir::quantised_codec_test {
namespace {

constexpr Box kNode{{-16, 8, 0}, {-8, 16, 8}};

std::array<std::uint16_t, kLeafVoxels> some_codes(unsigned bits) {
  std::array<std::uint16_t, kLeafVoxels> codes{};
  for (std::size_t i = 0; i < codes.size(); ++i) codes[i] = static_cast<std::uint16_t>((i * 40503U + 7) % (1U << bits));
  return codes;
}

template <typename Build>
void expect_stock_reads(GridType type, unsigned bits_log2, const Box& inside) {
  const unsigned bits = 1U << bits_log2;
  const auto codes = some_codes(bits);
  const float minimum = -1.25F;
  const float quantum = 0.37F;
  LeafValues decoded;
  for (std::size_t i = 0; i < codes.size(); ++i) decoded[i] = dequantize(codes[i], quantum, minimum);
  const NodeStatistics statistics = leaf_statistics(decoded, kNode, inside);
  alignas(32) std::array<std::byte, 2144> image;
  image.fill(std::byte{0xEE});
  const std::size_t size = quantised_leaf_bytes(bits_log2);
  encode_quantised_leaf(type, codes, bits_log2, minimum, quantum, kNode, inside, statistics,
                        std::span(image).first(size));
  EXPECT_EQ(image[size], std::byte{0xEE});

  const auto& leaf = *reinterpret_cast<const nanovdb::NanoLeaf<Build>*>(image.data());
  for (unsigned i = 0; i < kLeafVoxels; ++i) {
    ASSERT_EQ(leaf.getValue(i), decoded[i]) << i;
    ASSERT_EQ(leaf_value(type, image.data(), i), decoded[i]) << i;
    const Index3 voxel = kNode.lo + Index3{i >> 6U, i >> 3U & 7U, i & 7U};
    ASSERT_EQ(leaf.isActive(i), inside.contains({voxel, voxel + Index3{1, 1, 1}})) << i;
  }
  EXPECT_EQ(leaf.origin(), nanovdb::Coord(-16, 8, 0));
  EXPECT_NEAR(leaf.minimum(), statistics.min, 0.502F * quantum);
  EXPECT_NEAR(leaf.maximum(), statistics.max, 0.502F * quantum);
  EXPECT_NEAR(leaf.average(), statistics.average(), 0.502F * quantum);
  EXPECT_NEAR(leaf.stdDeviation(), statistics.deviation(), 0.502F * quantum);
}

TEST(QuantisedCodec, NanoVdbReadsEveryCodeWidth) {
  for (const Box& inside : {kNode, Box{{-14, 9, 0}, {-8, 16, 3}}}) {
    expect_stock_reads<nanovdb::Fp4>(GridType::fp4, 2, inside);
    expect_stock_reads<nanovdb::Fp8>(GridType::fp8, 3, inside);
    expect_stock_reads<nanovdb::Fp16>(GridType::fp16, 4, inside);
    for (unsigned log2 = 0; log2 <= 4; ++log2) expect_stock_reads<nanovdb::FpN>(GridType::fpn, log2, inside);
  }
}

TEST(QuantisedCodec, ConstantLeafHasZeroDeviation) {
  const std::array<std::uint16_t, kLeafVoxels> codes{};
  LeafValues decoded;
  decoded.fill(5);
  alignas(32) std::array<std::byte, 160> image;
  encode_quantised_leaf(GridType::fpn, codes, 0, 5, 0, kNode, kNode, leaf_statistics(decoded, kNode, kNode), image);
  const auto& leaf = *reinterpret_cast<const nanovdb::NanoLeaf<nanovdb::FpN>*>(image.data());
  EXPECT_EQ(leaf.minimum(), 5.0F);
  EXPECT_EQ(leaf.maximum(), 5.0F);
  EXPECT_EQ(leaf.average(), 5.0F);
  EXPECT_EQ(leaf.stdDeviation(), 0.0F);
  EXPECT_EQ(leaf.getValue(511), 5.0F);
}

}  // namespace
}  // namespace weir::quantised_codec_test
