// Tests what each kind promises about its values: shares, counts, exact values at chosen voxels.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "ingest/synthetic/synthetic.h"

namespace weir::fields_test {
namespace {

struct Volume {
  Index3 extent;
  std::vector<float> values;

  float at(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return values[static_cast<std::size_t>(linear_index({x, y, z}, extent))];
  }
  std::int64_t count(float value) const { return std::count(values.begin(), values.end(), value); }
  double share(float value) const { return static_cast<double>(count(value)) / static_cast<double>(values.size()); }
  double mean() const {
    double sum = 0;
    for (const float v : values) sum += static_cast<double>(v);
    return sum / static_cast<double>(values.size());
  }
  double deviation() const {
    const double m = mean();
    double sum = 0;
    for (const float v : values) sum += (static_cast<double>(v) - m) * (static_cast<double>(v) - m);
    return std::sqrt(sum / static_cast<double>(values.size()));
  }
};

Volume make_volume(std::string_view kind, const Index3& extent, std::uint64_t seed = 1) {
  const auto source = open_synthetic(kind, {extent, seed});
  Volume result{extent, std::vector<float>(static_cast<std::size_t>(volume(extent)))};
  source->read(source->info().domain(), result.values);
  return result;
}

TEST(Cloud, SixtyToNinetyPercentExactZeros) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U, 9U, 10U}) {
    const Volume cloud = make_volume("cloud", {64, 64, 64}, seed);
    EXPECT_GT(cloud.share(0.0F), 0.6) << seed;
    EXPECT_LT(cloud.share(0.0F), 0.9) << seed;
    EXPECT_TRUE(std::none_of(cloud.values.begin(), cloud.values.end(), [](float v) { return std::signbit(v); }));
    EXPECT_LT(*std::max_element(cloud.values.begin(), cloud.values.end()), 1.0F);
  }
}

TEST(Cloud, VoxelsOnTheFaces_AreNearlyAllEmpty) {
  const Volume cloud = make_volume("cloud", {96, 96, 96});
  int touching = 0;
  for (std::int64_t a = 0; a < 96; ++a) {
    for (std::int64_t b = 0; b < 96; ++b) {
      for (const std::int64_t face : {0, 95}) {
        touching += (cloud.at(face, a, b) > 0) + (cloud.at(a, face, b) > 0) + (cloud.at(a, b, face) > 0);
      }
    }
  }
  EXPECT_LT(touching, 96 * 96 * 6 / 100);
}

TEST(Cloud, InsideIsNotSmooth) {
  const Volume cloud = make_volume("cloud", {128, 128, 128});
  // The mean absolute difference of neighbours that both lie inside the cloud.
  double sum = 0;
  std::int64_t pairs = 0;
  for (std::size_t i = 0; i + 1 < cloud.values.size(); ++i) {
    const float a = cloud.values[i];
    const float b = cloud.values[i + 1];
    if (a <= 0.2F || b <= 0.2F) continue;
    sum += static_cast<double>(std::abs(a - b));
    ++pairs;
  }
  EXPECT_GT(pairs, 100000);
  EXPECT_GT(sum / static_cast<double>(pairs), 0.005);
  EXPECT_LT(sum / static_cast<double>(pairs), 0.03);
}

TEST(Turbulence, MeanNearZeroDeviationNearAFifth) {
  const Volume v = make_volume("turbulence", {128, 128, 128});
  EXPECT_NEAR(v.mean(), 0.0, 0.06);
  EXPECT_NEAR(v.deviation(), 0.2, 0.03);
  EXPECT_EQ(v.count(0.0F), 0);
}

TEST(Turbulence, BandLimitedSoNeighboursAgree) {
  const Volume v = make_volume("turbulence", {64, 64, 64});
  for (std::size_t i = 0; i + 1 < v.values.size(); ++i) {
    if (i % 64 == 63) continue;
    ASSERT_LT(std::abs(v.values[i] - v.values[i + 1]), 0.25F);
  }
}

TEST(Noise, UniformAndUncorrelated) {
  const Volume v = make_volume("noise", {64, 64, 64});
  EXPECT_NEAR(v.mean(), 0.5, 0.003);
  EXPECT_NEAR(v.deviation(), std::sqrt(1.0 / 12.0), 0.002);
  for (const std::size_t lag : {std::size_t{1}, std::size_t{64}, std::size_t{4096}}) {
    double sum = 0;
    for (std::size_t i = 0; i + lag < v.values.size(); ++i) {
      sum += (static_cast<double>(v.values[i]) - 0.5) * (static_cast<double>(v.values[i + lag]) - 0.5);
    }
    EXPECT_NEAR(sum / static_cast<double>(v.values.size()) * 12.0, 0.0, 0.01) << lag;
  }
}

TEST(Sphere, ShellsOnTheAxis) {
  const Volume v = make_volume("sphere", {101, 101, 101});  // the centre is voxel 50, r = |x - 50| / 50.5
  EXPECT_EQ(v.at(50, 50, 50), 0.0F);
  EXPECT_EQ(v.at(55, 50, 50), 0.0F);                                                      // between centre and shell 1
  EXPECT_NEAR(v.at(60, 50, 50), 0.25 * (1 - std::pow((10 / 50.5 - 0.2) * 20, 2)), 1e-6);  // shell 1
  EXPECT_NEAR(v.at(50, 20, 50), 0.75 * (1 - std::pow((30 / 50.5 - 0.6) * 20, 2)), 1e-6);  // shell 3
  EXPECT_NEAR(v.at(50, 50, 90), 1.00 * (1 - std::pow((40 / 50.5 - 0.8) * 20, 2)), 1e-6);  // shell 4
  EXPECT_EQ(v.at(100, 50, 50), 0.0F);
  EXPECT_EQ(v.at(0, 0, 0), 0.0F);
}

TEST(Gradient, LinearInTheSumOfTheIndices) {
  const Volume v = make_volume("gradient", {11, 21, 31});  // 60 steps
  EXPECT_EQ(v.at(0, 0, 0), 0.0F);
  EXPECT_EQ(v.at(10, 20, 30), 1.0F);
  EXPECT_EQ(v.at(5, 10, 15), 0.5F);
  EXPECT_EQ(v.at(1, 2, 3), 0.1F);
}

TEST(Huge, SpansTheRangeOfFloat) {
  const Volume v = make_volume("huge", {9, 9, 9});
  EXPECT_EQ(v.at(0, 0, 0), -3e38F);
  EXPECT_EQ(v.at(8, 8, 8), 3e38F);
  EXPECT_EQ(v.at(4, 4, 4), 0.0F);
  EXPECT_TRUE(std::isinf(v.at(8, 8, 8) - v.at(0, 0, 0)));
}

TEST(Constant, EveryVoxel) {
  EXPECT_EQ(make_volume("constant", {33, 9, 5}).count(0.5F), 33 * 9 * 5);
  for (const float v : make_volume("zero", {33, 9, 5}).values) ASSERT_EQ(std::bit_cast<std::uint32_t>(v), 0U);
  for (const float v : make_volume("nan", {33, 9, 5}).values) ASSERT_EQ(std::bit_cast<std::uint32_t>(v), 0x7fc00000U);
}

TEST(SomeNan, ExactCountsAndPlaces) {
  const Volume v = make_volume("some-nan", {97, 10, 10});
  std::map<std::string, int> count;
  for (const float value : v.values) {
    ++count[std::isnan(value) ? "nan" : std::isinf(value) ? (value > 0 ? "+inf" : "-inf") : "finite"];
  }
  EXPECT_EQ(count, (std::map<std::string, int>{{"nan", 100}, {"+inf", 100}, {"-inf", 100}, {"finite", 9400}}));
  EXPECT_TRUE(std::isnan(v.at(13, 4, 5)));
  EXPECT_EQ(v.at(41, 4, 5), std::numeric_limits<float>::infinity());
  EXPECT_EQ(v.at(77, 4, 5), -std::numeric_limits<float>::infinity());
}

TEST(NegativeZero, BothZerosAndNothingElse) {
  const Volume v = make_volume("negative-zero", {64, 64, 64});
  EXPECT_EQ(v.count(0.0F), 64 * 64 * 64);
  const auto negative = std::count_if(v.values.begin(), v.values.end(), [](float f) { return std::signbit(f); });
  EXPECT_NEAR(static_cast<double>(negative), 131072.0, 1500.0);
}

TEST(Denormal, EveryValueIsSubnormal) {
  const Volume v = make_volume("denormal", {32, 32, 32});
  for (const float f : v.values) ASSERT_EQ(std::fpclassify(f), FP_SUBNORMAL);
  EXPECT_LE(*std::max_element(v.values.begin(), v.values.end()), 4096 * std::numeric_limits<float>::denorm_min());
}

TEST(Tiny, DeviationOfTwoTimesTenToTheMinusSeventeen) {
  EXPECT_NEAR(make_volume("tiny", {128, 128, 128}).deviation(), 2e-17, 3e-18);
}

TEST(Offset, StepsOfEightAroundTenToTheEight) {
  const Volume v = make_volume("offset", {64, 64, 64});
  for (const float f : v.values) {
    const auto whole = static_cast<std::int64_t>(f);
    ASSERT_EQ(whole % 8, 0);
    ASSERT_LT(std::abs(whole - 100000000), 8 * 33);
  }
  EXPECT_LT(v.share(1e8F), 0.2);
}

TEST(BigInteger, EvenAndAboveTwoToTheTwentyFour) {
  const Volume v = make_volume("big-integer", {32, 32, 32});
  std::int64_t lowest = 1 << 30;
  std::int64_t highest = 0;
  for (const float f : v.values) {
    const auto whole = static_cast<std::int64_t>(f);
    ASSERT_EQ(static_cast<float>(whole), f);
    ASSERT_EQ(whole % 2, 0);
    lowest = std::min(lowest, whole);
    highest = std::max(highest, whole);
  }
  EXPECT_GE(lowest, 1 << 24);
  EXPECT_LT(lowest, (1 << 24) + 1000);
  EXPECT_LT(highest, (1 << 24) + (1 << 21));
  EXPECT_GT(highest, (1 << 24) + (1 << 21) - 1000);
}

TEST(Ties, FourModesEquallyFrequentAndARest) {
  const Volume v = make_volume("ties", {7, 5, 3});  // 105 = 4 * 26 + 1
  for (const float mode : {0.125F, 0.375F, 0.625F, 0.875F}) EXPECT_EQ(v.count(mode), 26) << mode;
  EXPECT_EQ(v.count(0.0F), 1);
  EXPECT_EQ(v.at(6, 4, 2), 0.0F);
}

TEST(Background, ConstantOutsideTheBallAndBothSignsInside) {
  const Volume v = make_volume("background", {64, 64, 64});
  EXPECT_NEAR(v.share(0.25F), 1.0 - 4.0 / 3.0 * 3.14159265 * 0.4 * 0.4 * 0.4, 0.01);
  EXPECT_EQ(v.at(0, 0, 0), 0.25F);
  EXPECT_LT(*std::min_element(v.values.begin(), v.values.end()), 0.0F);
  EXPECT_GT(*std::max_element(v.values.begin(), v.values.end()), 0.5F);
  const Volume zero = make_volume("signed", {64, 64, 64});
  EXPECT_EQ(zero.count(0.0F), v.count(0.25F));
  EXPECT_LT(*std::min_element(zero.values.begin(), zero.values.end()), -0.2F);
  EXPECT_GT(*std::max_element(zero.values.begin(), zero.values.end()), 0.2F);
}

TEST(HotVoxel, OneVoxelIsOneAndTheRestZero) {
  const Volume v = make_volume("hot-voxel", {100, 70, 50});
  EXPECT_EQ(v.count(1.0F), 1);
  EXPECT_EQ(v.count(0.0F), 100 * 70 * 50 - 1);
  EXPECT_EQ(make_volume("hot-voxel", {1, 1, 1}).at(0, 0, 0), 1.0F);
}

TEST(Plateau, TwoSpikes) {
  const Volume v = make_volume("plateau", {10, 10, 8});  // 800 voxels: floor(n/3) = 266, floor(2n/3) = 533
  EXPECT_EQ(v.at(6, 6, 2), 1e6F);
  EXPECT_EQ(v.at(3, 3, 5), -1e6F);
  EXPECT_EQ(v.count(1.0F), 798);
  EXPECT_EQ(make_volume("plateau", {1, 1, 1}).at(0, 0, 0), 1e6F);
  EXPECT_EQ(make_volume("plateau", {2, 1, 1}).at(1, 0, 0), -1e6F);
}

TEST(Checkerboard, EveryNeighbourDiffers) {
  const Volume v = make_volume("checkerboard", {5, 4, 3});
  EXPECT_EQ(v.at(0, 0, 0), 0.0F);
  EXPECT_EQ(v.at(1, 0, 0), 1.0F);
  EXPECT_EQ(v.at(0, 1, 0), 1.0F);
  EXPECT_EQ(v.at(0, 0, 1), 1.0F);
  EXPECT_EQ(v.at(4, 3, 2), 1.0F);
  EXPECT_EQ(v.count(1.0F), 30);
}

TEST(NearlyConstant, EveryLeafHasOneOddVoxel) {
  const Volume v = make_volume("nearly-constant", {33, 20, 9});
  const NodeLattice leaves = make_lattice({{0, 0, 0}, v.extent}, kLeafDim);
  std::vector<int> odd(static_cast<std::size_t>(leaves.size()));
  for (std::int64_t z = 0; z < 9; ++z) {
    for (std::int64_t y = 0; y < 20; ++y) {
      for (std::int64_t x = 0; x < 33; ++x) {
        ASSERT_TRUE(v.at(x, y, z) == 1.0F || v.at(x, y, z) == 2.0F);
        if (v.at(x, y, z) == 2.0F) ++odd[static_cast<std::size_t>(leaves.linear({x / 8, y / 8, z / 8}))];
      }
    }
  }
  EXPECT_EQ(odd, std::vector<int>(odd.size(), 1));
}

}  // namespace
}  // namespace weir::fields_test
