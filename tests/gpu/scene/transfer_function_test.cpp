#include "gpu/scene/transfer_function.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <limits>

#include "format/base/error.h"
#include "gpu/math/random.h"

namespace weir::transfer_function_test {
namespace {

const TransferFunction kRamp({{0, 0, 0, 0}, {0.5F, 0, 1, 0.25F}, {1, 0, 0, 1}}, -1, 3);

TEST(TransferFunction, LinearBetweenEntries) {
  EXPECT_EQ(kRamp.at(-1), (Rgba{0, 0, 0, 0}));
  EXPECT_EQ(kRamp.at(0), (Rgba{0.25F, 0, 0.5F, 0.125F}));
  EXPECT_EQ(kRamp.at(1), (Rgba{0.5F, 0, 1, 0.25F}));
  EXPECT_EQ(kRamp.at(2), (Rgba{0.75F, 0, 0.5F, 0.625F}));
  EXPECT_EQ(kRamp.at(3), (Rgba{1, 0, 0, 1}));
}

TEST(TransferFunction, EndsExtend) {
  EXPECT_EQ(kRamp.at(-FLT_MAX), kRamp.at(-1));
  EXPECT_EQ(kRamp.at(FLT_MAX), kRamp.at(3));
}

TEST(TransferFunction, NotANumberIsTransparent) {
  const TransferFunction opaque({{1, 1, 1, 1}, {1, 1, 1, 1}}, 0, 1);
  EXPECT_EQ(opaque.at(std::numeric_limits<float>::quiet_NaN()), (Rgba{}));
  EXPECT_EQ(opaque.at(kInfinity), (Rgba{}));
  EXPECT_EQ(opaque.at(-kInfinity), (Rgba{}));
}

TEST(TransferFunction, RangeOfOneValue) {
  const TransferFunction one({{0, 0, 0, 0}, {1, 1, 1, 1}}, 5, 5);
  EXPECT_EQ(one.at(5).a, 0.5F);
  EXPECT_EQ(one.at(4).a, 0.0F);
  EXPECT_EQ(one.at(6).a, 1.0F);
  EXPECT_GE(one.max_opacity(5, 5), 0.5F);
}

// 0.1 blended with itself may come out an ulp above or below.
TEST(TransferFunction, RangeOfOneValue_HoldsWhatABlendRoundsItTo) {
  for (const float value : {0.1F, -0.1F, 3e38F}) {
    const TransferFunction one({{0, 0, 0, 0}, {1, 1, 1, 1}}, value, value);
    EXPECT_EQ(one.at(std::nextafter(value, -kInfinity)).a, 0.5F) << value;
    EXPECT_EQ(one.at(std::nextafter(value, kInfinity)).a, 0.5F) << value;
    EXPECT_EQ(one.at(value * 0.9999F).a, value > 0 ? 0.0F : 1.0F) << value;
    EXPECT_GE(one.max_opacity(value, value), 0.5F) << value;
  }
  const TransferFunction zero({{0, 0, 0, 0}, {1, 1, 1, 1}}, 0, 0);
  EXPECT_EQ(zero.at(0).a, 0.5F);
  EXPECT_EQ(zero.at(1e-45F).a, 1.0F);
}

TEST(TransferFunction, RangeThatOverflowsAndDenormalRange) {
  const TransferFunction huge({{0, 0, 0, 0}, {1, 1, 1, 1}}, -3e38F, 3e38F);
  EXPECT_EQ(huge.at(0).a, 0.5F);
  EXPECT_EQ(huge.at(3e38F).a, 1.0F);
  const TransferFunction tiny({{0, 0, 0, 0}, {1, 1, 1, 1}}, 0, 4e-45F);
  EXPECT_EQ(tiny.at(0).a, 0.0F);
  EXPECT_NEAR(tiny.at(1.5e-45F).a, 1.0F / 3, 1e-6F);
  EXPECT_EQ(tiny.at(4e-45F).a, 1.0F);
}

TEST(TransferFunction, MaximumInsideTheInterval) {
  const TransferFunction tent({{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 1}, {0, 0, 0, 0}, {0, 0, 0, 0.5F}}, 0, 4);
  EXPECT_NEAR(tent.max_opacity(0, 4), 1.0F, 1e-5F);
  EXPECT_NEAR(tent.max_opacity(2.5F, 4), 0.5F, 1e-5F);
  EXPECT_NEAR(tent.max_opacity(1.5F, 1.75F), 0.75F, 1e-5F);
  EXPECT_EQ(tent.max_opacity(0, 0.5F), 0.0F) << "an empty cell stays empty";
  EXPECT_NEAR(tent.max_opacity(9, 9), 0.5F, 1e-5F);
}

TEST(TransferFunction, UnknownBoundsTakeTheLargest) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(kRamp.max_opacity(nan, 0), 1.0F);
  EXPECT_EQ(kRamp.max_opacity(0, kInfinity), 1.0F);
  EXPECT_EQ(kRamp.max_opacity(2, 1), 1.0F);
}

// The bound holds for every value of the interval of any table, and is tight.
TEST(TransferFunction, MaximumIsABoundForRandomTables) {
  for (std::uint64_t k = 0; k < 300; ++k) {
    Random random(2, k, 0);
    std::vector<Rgba> table(2 + random.bits() % 40);
    for (Rgba& entry : table) entry.a = random.bits() % 3 == 0 ? 0 : random.uniform();
    const float low = (random.uniform() - 0.5F) * 1e3F;
    const TransferFunction transfer(table, low, low + random.uniform() * 10);
    for (int interval = 0; interval < 50; ++interval) {
      float a = low - 1 + 12 * random.uniform();
      float b = low - 1 + 12 * random.uniform();
      if (a > b) std::swap(a, b);
      const float bound = transfer.max_opacity(a, b);
      float seen = std::max(transfer.at(a).a, transfer.at(b).a);
      for (int i = 0; i < 200; ++i) seen = std::max(seen, transfer.at(mix(a, b, random.uniform())).a);
      ASSERT_GE(bound, seen);
    }
  }
}

TEST(TransferFunction, RefusesInvalidTablesAndRanges) {
  EXPECT_THROW(TransferFunction({{}}, 0, 1), Error);
  EXPECT_THROW(TransferFunction({{}, {}}, 1, 0), Error);
  EXPECT_THROW(TransferFunction({{}, {}}, 0, kInfinity), Error);
}

}  // namespace
}  // namespace weir::transfer_function_test
