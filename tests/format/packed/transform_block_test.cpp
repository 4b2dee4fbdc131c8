#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/format/packed/block_samples.h"

namespace weir::transform_block_test {
namespace {

using packed_test::BlockValues;
using packed_test::constants_from;
using packed_test::decode;
using packed_test::kShapes;
using packed_test::Numbers;
using packed_test::same_bits;
using packed_test::sample;
using packed_test::Shape;
using packed_test::Stream;

double squared_error(const BlockValues& a, const BlockValues& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double difference = static_cast<double>(a[i]) - static_cast<double>(b[i]);
    sum += difference * difference;
  }
  return sum;
}

struct Counts {
  unsigned blocks = 0;
  unsigned dropped = 0;  // of those the last coefficients did not fit the promised bytes
};

// Encodes at the promised length and checks what comes out.
void check_step(TransformBlock& block, const BlockValues& values, const MeanRange& means, std::int32_t step,
                Counts& counts) {
  const BlockConstants constants = constants_from(std::max(kLeastStep, step - 20));
  const TransformBlock::Cost cost = block.cost(step);
  const unsigned number_bits = mean_bits(means, step);
  if (number_bits == kNoMeanBits) return;
  const std::uint32_t promised = stream_bytes(cost.bits, number_bits);
  if (promised > kRawStreamBytes) return;
  // The byte after the promised ones is not written.
  Stream room(promised + 1, std::byte{0xA5});
  block.encode(constants, means, step, std::span(room).first(promised));
  ASSERT_EQ(room.back(), std::byte{0xA5});
  const auto decoded = decode(constants, means, std::span(room).first(promised));
  ASSERT_TRUE(decoded.has_value());
  const bool mean_alone = (static_cast<unsigned>(room[0]) & 3U) == 0;
  ASSERT_EQ(mean_alone, cost.bits <= 8);
  BlockValues known;
  ASSERT_EQ(block.decoded(constants, means, step, known), !mean_alone);
  ASSERT_TRUE(mean_alone || same_bits(known, *decoded)) << "step " << step;

  Stream longer(promised + 64);
  block.encode(constants, means, step, longer);
  const auto whole = decode(constants, means, longer);
  ASSERT_TRUE(whole.has_value());
  ++counts.blocks;
  if (!same_bits(*decoded, *whole)) ++counts.dropped;

  // Of the mean at most half a quantum; of float arithmetic some units of the values.
  const auto size = static_cast<double>(step_size(step));
  double largest = 0;
  for (const float v : values) largest = std::max(largest, std::fabs(static_cast<double>(v)));
  const double rounding = 512 * largest * largest * 0x1p-40;
  const double error = squared_error(values, *whole);
  const double cross = 2 * std::sqrt(cost.squared_error * rounding);
  ASSERT_LE(error, cost.squared_error * 1.001 + size * size / 4 * 1.001 + 4 * rounding + 4 * cross);
  ASSERT_GE(error, cost.squared_error * 0.999 - 4 * rounding - 4 * cross);
}

MeanRange means_around(float mean, float width) { return {mean - width * 0.37F, mean + width * 0.63F}; }

TEST(TransformBlock, DecodedErrorIsThePromisedOneAndFewBlocksDropCoefficients) {
  Numbers numbers(11);
  TransformBlock block;
  Counts counts;
  for (const Shape shape : kShapes) {
    for (int trial = 0; trial < 24; ++trial) {
      const float amplitude = std::ldexp(1.0F, static_cast<int>(numbers.below(24)) - 12);
      const BlockValues values = sample(shape, numbers, amplitude, amplitude * 4 * numbers.signed_unit());
      if (!block.set(values)) continue;
      const auto first = static_cast<std::int32_t>(std::floor(-2 * std::log2(block.largest() / 0.6)));
      for (std::int32_t step = first - 1; step < first + 24; ++step) {
        check_step(block, values, means_around(block.mean(), amplitude * 8), step, counts);
        if (HasFatalFailure()) return;
      }
    }
  }
  RecordProperty("blocks", static_cast<int>(counts.blocks));
  RecordProperty("dropped", static_cast<int>(counts.dropped));
  EXPECT_GT(counts.blocks, 2000U);
  EXPECT_LT(counts.dropped * 100, counts.blocks) << counts.dropped << " of " << counts.blocks;
}

TEST(TransformBlock, MeansOfANarrowRangeAreDecodedToo) {
  Numbers numbers(12);
  TransformBlock block;
  Counts counts;
  for (const Shape shape : kShapes) {
    for (int trial = 0; trial < 12; ++trial) {
      const BlockValues values = sample(shape, numbers, 1, numbers.signed_unit());
      if (!block.set(values)) continue;
      const auto first = static_cast<std::int32_t>(std::floor(-2 * std::log2(block.largest() / 0.6)));
      for (std::int32_t step = first - 1; step < first + 24; ++step) {
        check_step(block, values, {block.mean(), block.mean()}, step, counts);
        if (HasFatalFailure()) return;
      }
    }
  }
  RecordProperty("blocks", static_cast<int>(counts.blocks));
  RecordProperty("dropped", static_cast<int>(counts.dropped));
  EXPECT_LT(counts.dropped * 100, counts.blocks) << counts.dropped << " of " << counts.blocks;
}

TEST(TransformBlock, ShorterStreamsLoseCoefficientsAndStayValid) {
  Numbers numbers(13);
  TransformBlock block;
  for (const Shape shape : kShapes) {
    const BlockValues values = sample(shape, numbers, 1, 0.25F);
    ASSERT_TRUE(block.set(values));
    const std::int32_t step = 4;
    const BlockConstants constants = constants_from(0);
    const MeanRange means = means_around(block.mean(), 2);
    const std::uint32_t promised = stream_bytes(block.cost(step).bits, mean_bits(means, step));
    const std::uint32_t least = stream_bytes(8, mean_bits(means, step));
    Stream whole(promised + 8);
    block.encode(constants, means, step, whole);
    ASSERT_FALSE(block.dropped());
    const auto all = decode(constants, means, whole);
    ASSERT_TRUE(all.has_value());
    unsigned known_after_drops = 0;
    double last = squared_error(values, BlockValues{}) * 2;
    for (std::uint32_t bytes = least; bytes <= promised + 8; bytes += bytes < 40 ? 1 : 7) {
      Stream stream(bytes);
      block.encode(constants, means, step, stream);
      const auto decoded = decode(constants, means, stream);
      ASSERT_TRUE(decoded.has_value()) << bytes;
      ASSERT_EQ(block.dropped(), !same_bits(*decoded, *all)) << bytes;
      BlockValues known;
      if (block.decoded(constants, means, step, known)) {
        ASSERT_TRUE(same_bits(known, *decoded)) << bytes;
        known_after_drops += block.dropped() ? 1 : 0;
      }
      // More bytes are no worse, but for what a dead zone leaves.
      const double error = squared_error(values, *decoded);
      ASSERT_LE(error, last + 1) << bytes;
      last = error;
    }
    EXPECT_GT(known_after_drops, 0U);
  }
}

TEST(TransformBlock, LongerStreamsDecodeToTheSameValues) {
  Numbers numbers(14);
  TransformBlock block;
  for (const Shape shape : kShapes) {
    ASSERT_TRUE(block.set(sample(shape, numbers, 1, 0.25F)));
    for (const std::int32_t step : {-2, 0, 3, 8, 14}) {
      const BlockConstants constants = constants_from(-10);
      const MeanRange means = means_around(block.mean(), 2);
      const std::uint32_t enough = stream_bytes(block.cost(step).bits, mean_bits(means, step)) + 4;
      Stream stream(enough);
      block.encode(constants, means, step, stream);
      const auto expected = decode(constants, means, stream);
      ASSERT_TRUE(expected.has_value());
      for (const std::uint32_t more : {1U, 2U, 3U, 17U, 1000U}) {
        Stream longer(enough + more, std::byte{0xFF});
        block.encode(constants, means, step, longer);
        const auto decoded = decode(constants, means, longer);
        ASSERT_TRUE(decoded.has_value());
        ASSERT_TRUE(same_bits(*decoded, *expected));
      }
    }
  }
}

TEST(TransformBlock, CoarseStepsKeepTheMeanAlone) {
  Numbers numbers(15);
  TransformBlock block;
  const BlockValues values = sample(Shape::noisy, numbers, 1, 100);
  ASSERT_TRUE(block.set(values));
  const MeanRange means{90, 110};
  for (std::int32_t step = -30; step < -8; ++step) {
    ASSERT_EQ(block.cost(step).bits, 8U);
    ASSERT_NEAR(block.cost(step).squared_error, block.energy(), 1e-6 * block.energy());
    const std::uint32_t bytes = stream_bytes(8, mean_bits(means, step));
    Stream stream(bytes);
    block.encode(constants_from(-30), means, step, stream);
    EXPECT_EQ(static_cast<unsigned>(stream[0]), static_cast<unsigned>(step + 30) << 2U);
    const auto decoded = decode(constants_from(-30), means, stream);
    ASSERT_TRUE(decoded.has_value());
    for (const float v : *decoded) ASSERT_EQ(v, (*decoded)[0]);
    ASSERT_NEAR((*decoded)[0], block.mean(), mean_quantum(step) * 0.5001F + 1e-5F);
    EXPECT_FALSE(decode(constants_from(-30), means, std::span(stream).first(bytes - 1)).has_value());
  }
}

TEST(TransformBlock, ValuesAreClamped) {
  Numbers numbers(16);
  TransformBlock block;
  ASSERT_TRUE(block.set(sample(Shape::noisy, numbers, 1, 0)));
  const MeanRange means = means_around(block.mean(), 1);
  for (const std::int32_t step : {0, 3, 7}) {
    BlockConstants constants = constants_from(0);
    Stream stream(stream_bytes(block.cost(step).bits, mean_bits(means, step)) + 4);
    block.encode(constants, means, step, stream);
    const auto free = decode(constants, means, stream);
    constants.minimum = -0.25F;
    constants.maximum = 0.125F;
    const auto clamped = decode(constants, means, stream);
    ASSERT_TRUE(free && clamped);
    for (std::size_t i = 0; i < 512; ++i) ASSERT_EQ((*clamped)[i], std::clamp((*free)[i], -0.25F, 0.125F));
    EXPECT_EQ(*std::min_element(clamped->begin(), clamped->end()), -0.25F);
    EXPECT_EQ(*std::max_element(clamped->begin(), clamped->end()), 0.125F);
  }
}

TEST(TransformBlock, ExtremeSizesAreEncoded) {
  Numbers numbers(17);
  TransformBlock block;
  Counts counts;
  for (const float amplitude : {1e-28F, 1e-20F, 1e20F, 9e29F}) {
    const BlockValues values = sample(Shape::noisy, numbers, amplitude, 0);
    ASSERT_TRUE(block.set(values));
    const auto first = static_cast<std::int32_t>(std::floor(-2 * std::log2(block.largest() / 0.6)));
    for (std::int32_t step = first; step < first + 20; step += 3) {
      if (step < kLeastStep || step > kMostStep) continue;
      check_step(block, values, means_around(block.mean(), amplitude), step, counts);
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_GT(counts.blocks, 20U);
}

TEST(TransformBlock, ConstantTooLargeAndTooSmallBlocksAreRefused) {
  TransformBlock block;
  BlockValues values;
  values.fill(3);
  EXPECT_FALSE(block.set(values));
  values[5] = 2e30F;
  EXPECT_FALSE(block.set(values));
  values[5] = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(block.set(values));
  values.fill(0);
  values[5] = std::numeric_limits<float>::denorm_min();
  EXPECT_FALSE(block.set(values));
}

}  // namespace
}  // namespace weir::transform_block_test
