#include "format/leaf/leaf_decode.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace weir::leaf_decode_test {
namespace {

TEST(LeafDecode, DequantizeDoesNotFuseMultiplyAndAdd) {
  // Found by search: the fused result differs in the last bit.
  std::uint32_t differing = 0;
  for (std::uint32_t code = 0; code < 65536; ++code) {
    const float quantum = 0.1F;
    const float minimum = 0.3F;
    const float fused = std::fma(static_cast<float>(code), quantum, minimum);
    const volatile float product = static_cast<float>(code) * quantum;
    const float twice = product + minimum;
    EXPECT_EQ(dequantize(code, quantum, minimum), twice);
    differing += fused != twice ? 1 : 0;
  }
  EXPECT_GT(differing, 1000U);
}

TEST(LeafDecode, CodesArePackedFromTheLowestBit) {
  std::array<std::byte, 1024> codes{};
  for (std::size_t i = 0; i < codes.size(); ++i) codes[i] = static_cast<std::byte>(i * 37 + 11);
  for (unsigned log2 = 0; log2 <= kMaxLeafBitsLog2; ++log2) {
    const unsigned bits = 1U << log2;
    for (unsigned i = 0; i < 512; ++i) {
      std::uint32_t expected = 0;
      for (unsigned b = 0; b < bits; ++b) {
        const unsigned at = i * bits + b;
        expected |= (static_cast<unsigned>(codes[at >> 3U]) >> (at & 7U) & 1U) << b;
      }
      ASSERT_EQ(leaf_code(codes.data(), log2, i), expected) << bits << " bits, voxel " << i;
    }
  }
}

TEST(LeafDecode, InvalidWidthsOfADamagedLeafCountAsTheLargest) {
  std::array<std::byte, nvdb::kLeafHeadBytes + 1024> leaf{};
  for (unsigned log2 = 0; log2 < 8; ++log2) {
    leaf[nvdb::leaf::kFlags] = static_cast<std::byte>(log2 << 5U | 2U);
    EXPECT_EQ(fpn_bits_log2(leaf.data()), log2);
    EXPECT_EQ(leaf_bits_log2(GridType::fpn, leaf.data()), log2 < 4 ? log2 : 4);
  }
  EXPECT_EQ(leaf_bits_log2(GridType::fp4, leaf.data()), 2U);
  EXPECT_EQ(leaf_bits_log2(GridType::fp8, leaf.data()), 3U);
  EXPECT_EQ(leaf_bits_log2(GridType::fp16, leaf.data()), 4U);
}

TEST(LeafDecode, ActiveBitsAreOfTheValueMask) {
  std::array<std::byte, nvdb::kLeafHeadBytes> leaf{};
  leaf[nvdb::leaf::kValueMask + 63] = std::byte{0x80};
  leaf[nvdb::leaf::kValueMask] = std::byte{0x02};
  for (unsigned i = 0; i < 512; ++i) EXPECT_EQ(leaf_active(leaf.data(), i), i == 1 || i == 511) << i;
}

}  // namespace
}  // namespace weir::leaf_decode_test
