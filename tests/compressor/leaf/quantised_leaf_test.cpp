#include "compressor/leaf/quantised_leaf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "format/leaf/leaf_decode.h"
#include "format/leaf/quantised_codec.h"

namespace weir::quantised_leaf_test {
namespace {

constexpr Box kNode{{8, -16, 0}, {16, -8, 8}};
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

std::uint32_t bits_of(float value) { return std::bit_cast<std::uint32_t>(value); }

template <typename Value>
LeafValues filled(const Value& value) {
  LeafValues values;
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = value(i);
  return values;
}

LeafValues random_values(unsigned seed) {
  std::mt19937 random(seed);
  return filled([&](std::size_t) { return static_cast<float>(random() >> 8U) * 0x1p-24F - 0.25F; });
}

QuantisedLeaf quantised(const LeafValues& values, unsigned bits_log2) {
  return quantise_leaf(values, values, kNode, kNode, bits_log2);
}

void expect_exact(const QuantisedLeaf& leaf, const LeafValues& values) {
  for (std::size_t i = 0; i < values.size(); ++i) ASSERT_EQ(bits_of(leaf.decoded[i]), bits_of(values[i])) << i;
  EXPECT_EQ(leaf.kept, Kept::all);
  EXPECT_EQ(leaf.squared_error, 0);
  EXPECT_EQ(leaf.max_abs, 0);
}

TEST(QuantisedLeaf, OneValueIsExactAtEveryWidthWhateverItIs) {
  for (const float v : {0.0F, -0.0F, 0.1F, -7.5F, 3e38F, -3e38F, 0x1p-149F, 1e-16F, 1e8F}) {
    for (unsigned log2 = 0; log2 <= 4; ++log2) {
      const LeafValues values = filled([&](std::size_t) { return v; });
      expect_exact(quantised(values, log2), values);
    }
  }
}

TEST(QuantisedLeaf, WholeNumbersAreExactAtTheFirstWidthThatHoldsTheirRange) {
  for (unsigned log2 = 0; log2 <= 4; ++log2) {
    const std::uint64_t levels = std::uint64_t{1} << (1U << log2);
    std::mt19937 random(log2);
    LeafValues values =
        filled([&](std::size_t) { return static_cast<float>(static_cast<double>(random() % levels) - 20000.0); });
    values[3] = -20000;
    values[5] = static_cast<float>(static_cast<double>(levels) - 20001.0);
    expect_exact(quantised(values, log2), values);
    values[7] = values[5] + 1;  // one level more than there are codes
    values[9] = values[3] + 1;  // rules out a coarser lattice
    const QuantisedLeaf lossy = quantised(values, log2);
    EXPECT_EQ(lossy.kept, Kept::lossy);
    EXPECT_GT(lossy.squared_error, 0);
  }
}

TEST(QuantisedLeaf, ZerosOfBothSigns_HaveZeroErrorButAreNotExact) {
  const QuantisedLeaf leaf = quantised(filled([](std::size_t i) { return i % 2 == 0 ? -0.0F : 0.0F; }), 4);
  EXPECT_EQ(leaf.kept, Kept::lossy);
  EXPECT_EQ(leaf.squared_error, 0);
  EXPECT_EQ(leaf.max_abs, 0);
}

TEST(QuantisedLeaf, OneValueUnlikeAllOthersIsExactAtOneBit) {
  for (const auto& [most, other] : {std::pair{1.0F, 1.0F + 0x1p-23F}, {0.0F, 1.0F}, {-3.0F, 1e6F}, {0.1F, 0.3F}}) {
    LeafValues values = filled([most = most](std::size_t) { return most; });
    values[77] = other;
    expect_exact(quantised(values, 0), values);
  }
}

TEST(QuantisedLeaf, ErrorIsThatOfTheDecodedValuesAndMaxAbsRoundsUp) {
  for (unsigned log2 = 0; log2 <= 4; ++log2) {
    const LeafValues values = random_values(log2);
    const QuantisedLeaf leaf = quantised(values, log2);
    double squares = 0;
    double worst = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const float decoded = dequantize(leaf.codes[i], leaf.quantiser.quantum, leaf.quantiser.minimum);
      ASSERT_EQ(bits_of(leaf.decoded[i]), bits_of(decoded));
      const double error = static_cast<double>(values[i]) - static_cast<double>(decoded);
      squares += error * error;
      worst = std::max(worst, std::fabs(error));
    }
    EXPECT_NEAR(leaf.squared_error, squares, squares * 1e-13);
    EXPECT_GE(static_cast<double>(leaf.max_abs), worst);
    EXPECT_LT(static_cast<double>(std::nextafter(leaf.max_abs, 0.0F)), worst);
    EXPECT_EQ(leaf.kept, Kept::lossy);
  }
}

TEST(QuantisedLeaf, ReplacedValuesAreCodedButCountForNoError) {
  LeafValues source = random_values(1);
  for (std::size_t i = 0; i < source.size(); i += 7) source[i] = kNaN;
  LeafValues values = source;
  for (float& v : values) v = std::isnan(v) ? 50.0F : v;  // far outside the range of the other values
  const QuantisedLeaf leaf = quantise_leaf(values, source, kNode, kNode, 3);
  double squares = 0;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const double error = static_cast<double>(values[i]) - static_cast<double>(leaf.decoded[i]);
    EXPECT_LE(std::fabs(error), 51.0 / 255);
    if (!std::isnan(source[i])) squares += error * error;
  }
  EXPECT_NEAR(leaf.squared_error, squares, squares * 1e-13);
}

TEST(QuantisedLeaf, ReplacedValuesThatReadAnotherOne_LoseNoValue) {
  LeafValues source = filled([](std::size_t i) { return static_cast<float>(i % 2); });
  source[77] = kNaN;
  LeafValues values = source;
  values[77] = 0.3F;
  EXPECT_EQ(quantise_leaf(values, source, kNode, kNode, 0).kept, Kept::values);
  values[77] = 1;
  EXPECT_EQ(quantise_leaf(values, source, kNode, kNode, 0).kept, Kept::all);
  source[78] = 0.4F;
  values[78] = 0.4F;
  EXPECT_EQ(quantise_leaf(values, source, kNode, kNode, 0).kept, Kept::lossy);
}

TEST(QuantisedLeaf, VoxelsOutsideReadTheNearestInsideAndWidenNoRange) {
  const Box inside{{11, -16, 2}, {14, -9, 3}};
  LeafValues values = random_values(2);
  for (std::int64_t i = 0; i < kLeafVoxels; ++i) {
    const Index3 voxel = kNode.lo + Index3{i >> 6, i >> 3 & 7, i & 7};
    if (!inside.contains(voxel)) values[static_cast<std::size_t>(i)] = 1e30F;
  }
  for (unsigned log2 = 0; log2 <= 4; ++log2) {
    const QuantisedLeaf leaf = quantise_leaf(values, values, kNode, inside, log2);
    EXPECT_LT(leaf.quantiser.quantum * static_cast<float>((1U << (1U << log2)) - 1), 1.1F);
    for (std::int64_t i = 0; i < kLeafVoxels; ++i) {
      const Index3 voxel = kNode.lo + Index3{i >> 6, i >> 3 & 7, i & 7};
      const Index3 nearest = max(inside.lo, min(inside.hi - Index3{1, 1, 1}, voxel)) - kNode.lo;
      EXPECT_EQ(leaf.codes[static_cast<std::size_t>(i)],
                leaf.codes[static_cast<std::size_t>(nearest.x << 6 | nearest.y << 3 | nearest.z)]);
    }
  }
}

TEST(QuantisedLeaf, ARangeTooSmallForFloat_IsItsMeanAtEveryWidth_OrZeroWhereThatIsItsLeast) {
  for (const float least : {0.0F, 0x1p-131F}) {
    const LeafValues values = filled([least](std::size_t i) { return i % 4 == 0 ? least : 0x1p-130F; });
    for (unsigned log2 = 0; log2 <= 4; ++log2) {
      const QuantisedLeaf leaf = quantised(values, log2);
      EXPECT_EQ(leaf.quantiser.quantum, 0.0F);
      EXPECT_EQ(leaf.decoded[9], least == 0 ? 0.0F : static_cast<float>(0.875 * 0x1p-130));
      EXPECT_EQ(leaf.zeros_lost, 0U);
      EXPECT_EQ(leaf.kept, Kept::lossy);
    }
  }
}

TEST(QuantisedLeaf, TheImageDecodesToTheDecodedValues) {
  for (const auto& [type, log2] : {std::pair{GridType::fp4, 2U},
                                   {GridType::fp8, 3U},
                                   {GridType::fp16, 4U},
                                   {GridType::fpn, 0U},
                                   {GridType::fpn, 1U},
                                   {GridType::fpn, 2U},
                                   {GridType::fpn, 3U},
                                   {GridType::fpn, 4U}}) {
    const LeafValues values = random_values(3);
    const QuantisedLeaf leaf = quantised(values, log2);
    std::vector<std::byte> image(quantised_leaf_bytes(log2));
    encode_quantised_leaf(type, leaf.codes, leaf.bits_log2, leaf.quantiser.minimum, leaf.quantiser.quantum, kNode,
                          kNode, leaf_statistics(leaf.decoded, kNode, kNode), image);
    for (unsigned i = 0; i < kLeafVoxels; ++i) {
      ASSERT_EQ(bits_of(leaf_value(type, image.data(), i)), bits_of(leaf.decoded[i]));
    }
  }
}

}  // namespace
}  // namespace weir::quantised_leaf_test
