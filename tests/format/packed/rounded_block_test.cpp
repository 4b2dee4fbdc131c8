#include "format/packed/rounded_block.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "format/packed/near_rungs.h"
#include "tests/format/packed/block_samples.h"

namespace weir::rounded_block_test {
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

BlockValues decoded_from(const Stream& stream) {
  const auto values = decode(constants_from(0), {}, stream);
  EXPECT_TRUE(values.has_value());
  return values.value_or(BlockValues{});
}

double squared_error(const BlockValues& a, const BlockValues& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double error = static_cast<double>(a[i]) - static_cast<double>(b[i]);
    sum += error * error;
  }
  return sum;
}

TEST(RoundedBlock, EncodesToItsCostWithItsError) {
  Numbers numbers(3);
  RoundedBlock block;
  int tried = 0;
  for (const Shape shape : kShapes) {
    for (const float amplitude : {1e-6F, 0.7F, 4000.0F}) {
      for (const float offset : {0.0F, -3.0F, 5e6F}) {
        const BlockValues values = sample(shape, numbers, amplitude, offset);
        block.set(values);
        for (int bits = 6; bits <= kMostRoundedBits; ++bits) {
          const int exponent = block.exponent() - bits;
          const auto cost = block.cost(exponent);
          if (!cost) continue;
          ++tried;
          Stream stream(cost->bytes);
          ASSERT_TRUE(block.encode(exponent, stream));
          const BlockValues decoded = decoded_from(stream);
          BlockValues known;
          block.decoded(constants_from(0), known);
          ASSERT_TRUE(same_bits(known, decoded)) << "2^" << exponent;
          const double quantum = std::ldexp(1.0, exponent);
          for (std::size_t i = 0; i < values.size(); ++i) {
            const double multiple = static_cast<double>(decoded[i]) / quantum;
            ASSERT_EQ(multiple, std::nearbyint(multiple));
            ASSERT_LE(std::fabs(static_cast<double>(decoded[i]) - static_cast<double>(values[i])), quantum / 2);
          }
          ASSERT_NEAR(cost->squared_error, squared_error(values, decoded), 1e-12 * cost->squared_error);
        }
      }
    }
  }
  EXPECT_GT(tried, 400);
}

TEST(RoundedBlock, ALongerStreamHasZerosInItsMiddle) {
  Numbers numbers(4);
  const BlockValues values = sample(Shape::mixed, numbers, 1, 0);
  RoundedBlock block;
  block.set(values);
  const int exponent = block.exponent() - 14;
  Stream shortest(block.cost(exponent)->bytes);
  Stream longer(shortest.size() + 100);
  ASSERT_TRUE(block.encode(exponent, shortest));
  ASSERT_TRUE(block.encode(exponent, longer));
  EXPECT_EQ(decoded_from(shortest), decoded_from(longer));
}

TEST(RoundedBlock, KnownValuesLieInTheRangeOfTheFile) {
  Numbers numbers(7);
  const BlockValues values = sample(Shape::mixed, numbers, 1, 0);
  RoundedBlock block;
  block.set(values);
  const int exponent = block.exponent() - 4;
  Stream stream(block.cost(exponent)->bytes);
  ASSERT_TRUE(block.encode(exponent, stream));
  BlockConstants constants = constants_from(0);
  constants.minimum = *std::min_element(values.begin(), values.end());
  constants.maximum = *std::max_element(values.begin(), values.end());
  BlockValues known;
  block.decoded(constants, known);
  EXPECT_TRUE(same_bits(known, decode(constants, {}, stream).value()));
  EXPECT_FALSE(same_bits(known, decoded_from(stream))) << "some lie outside";
}

TEST(RoundedBlock, HalvesAreRoundedAwayFromZero) {
  BlockValues values;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float half = static_cast<float>(i / 6) + 0.5F;
    const float beside = i % 3 == 0 ? half : std::nextafter(half, i % 3 == 1 ? 0.0F : 1000.0F);
    values[i] = i % 2 == 0 ? beside : -beside;
  }
  RoundedBlock block;
  block.set(values);
  Stream stream(block.cost(0).value().bytes);
  ASSERT_TRUE(block.encode(0, stream));
  const BlockValues decoded = decoded_from(stream);
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(static_cast<double>(decoded[i]), std::round(static_cast<double>(values[i]))) << values[i];
  }
}

TEST(RoundedBlock, WhereTheStreamIsTooShortTheQuantumIsLarger) {
  Numbers numbers(5);
  const BlockValues values = sample(Shape::noisy, numbers, 1, 0);
  RoundedBlock block;
  block.set(values);
  const int exponent = block.exponent() - 16;
  Stream enough(block.cost(exponent)->bytes);
  ASSERT_TRUE(block.encode(exponent, enough));
  EXPECT_FALSE(block.coarser());
  Stream stream(enough.size() * 3 / 4);
  ASSERT_TRUE(block.encode(exponent, stream));
  EXPECT_TRUE(block.coarser());
  BlockValues known;
  block.decoded(constants_from(0), known);
  EXPECT_TRUE(same_bits(known, decoded_from(stream)));
  const double error = squared_error(values, decoded_from(stream));
  EXPECT_GT(error, block.cost(exponent)->squared_error * 100);
  EXPECT_LT(error, 0.001);
  Stream tiny(12);
  EXPECT_FALSE(block.encode(exponent, tiny));
}

TEST(RoundedBlock, ValuesThatNoLatticeHoldsHaveNoCost) {
  Numbers numbers(6);
  RoundedBlock block;
  block.set(sample(Shape::ramp, numbers, 0, 3));
  EXPECT_FALSE(block.cost(block.exponent() - 10)) << "one value";
  block.set(sample(Shape::ramp, numbers, 1, 0));
  EXPECT_FALSE(block.cost(block.exponent() - kMostRoundedBits - 1)) << "more than 24 bits";
  for (const float amplitude : {1e-44F, 1e-38F, 3e38F}) {
    block.set(sample(Shape::ramp, numbers, amplitude, 0));
    EXPECT_FALSE(block.cost(block.exponent() - 20)) << amplitude;
  }
}

}  // namespace
}  // namespace weir::rounded_block_test
