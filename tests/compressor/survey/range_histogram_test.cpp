#include "compressor/survey/range_histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <ostream>
#include <random>
#include <string>
#include <vector>

namespace weir::range_histogram_test {
namespace {

struct Expected {
  double width = 0;
  double first_edge = 0;
  std::vector<std::uint64_t> counts;
};

// Computes the histogram by its definition: the bin width is the finest power of two, at least 2^-149, with at most
// 1024 bins from the lowest to the highest value.
Expected expected_histogram(const std::vector<float>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  int exponent = -149;
  const auto bin = [&](float v) { return std::floor(std::ldexp(static_cast<double>(v), -exponent)); };
  while (bin(*high) - bin(*low) >= 1024) ++exponent;
  Expected expected{std::ldexp(1.0, exponent), std::ldexp(bin(*low), exponent), {}};
  expected.counts.resize(static_cast<std::size_t>(bin(*high) - bin(*low)) + 1);
  for (const float v : values) ++expected.counts[static_cast<std::size_t>(bin(v) - bin(*low))];
  return expected;
}

void add(RangeHistogram& histogram, std::span<const float> values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  histogram.add(values, *low, *high);
}

void expect_histogram(const RangeHistogram& histogram, const Expected& expected) {
  EXPECT_EQ(histogram.bin_width(), expected.width);
  EXPECT_EQ(histogram.first_edge(), expected.first_edge);
  EXPECT_EQ(histogram.counts(), expected.counts);
}

struct Values {
  std::string name;
  std::vector<float> values;
};

std::ostream& operator<<(std::ostream& out, const Values& v) { return out << v.name; }

std::vector<float> draw(std::size_t count, const std::function<float(std::mt19937&)>& value) {
  std::mt19937 random(7);
  std::vector<float> values(count);
  for (float& v : values) v = value(random);
  return values;
}

float uniform(std::mt19937& random) { return static_cast<float>(random() >> 8U) * 0x1p-24F; }

std::vector<Values> value_sets() {
  constexpr float kMax = std::numeric_limits<float>::max();
  constexpr float kLeast = std::numeric_limits<float>::denorm_min();
  return {
      {"Unit", draw(5000, uniform)},
      {"Signed", draw(5000, [](auto& r) { return uniform(r) - 0.5F; })},
      {"Normal", draw(5000, [](auto& r) { return std::normal_distribution<float>(3, 1e-3F)(r); })},
      {"LogUniform", draw(5000, [](auto& r) { return std::ldexp(uniform(r) + 1, static_cast<int>(r() % 276) - 149); })},
      {"AnyBits", draw(5000,
                       [](auto& r) {
                         float v = std::numeric_limits<float>::quiet_NaN();
                         while (!std::isfinite(v)) v = std::bit_cast<float>(static_cast<std::uint32_t>(r()));
                         return v;
                       })},
      {"Integers", draw(5000, [](auto& r) { return static_cast<float>(r() % 256); })},
      {"WideIntegers", draw(5000, [](auto& r) { return static_cast<float>(r() % 65536) - 32768; })},
      {"HugeBothSigns", draw(999, [](auto& r) { return (uniform(r) - 0.5F) * 2 * 3e38F; })},
      {"Extremes", {-kMax, kMax, 0.0F, -0.0F, kLeast, -kLeast, 1.0F}},
      {"OneHotVoxel", {0, 0, 0, 0, 3e38F, 0, 0}},
      {"PlateauWithSpikes", {1, 1, 1, 1e6F, 1, -1e6F, 1}},
      {"UlpEight", draw(5000, [](auto& r) { return 1e8F + 8.0F * static_cast<float>(r() % 4000); })},
      {"TwoNeighbours", {1e8F, 1e8F + 8, 1e8F}},
      {"Denormals", draw(5000, [](auto& r) { return static_cast<float>(r() % 4096) * kLeast; })},
      {"FewDenormals", draw(50, [](auto& r) { return (static_cast<float>(r() % 7) - 3) * kLeast; })},
      {"Zeros", {0.0F, -0.0F, -0.0F, 0.0F}},
      {"NegativeZeroOnly", {-0.0F, -0.0F}},
      {"OneValue", std::vector<float>(700, -17.25F)},
      {"Descending", {1024, 512, 256, 0.5F, 0, -1, -1000}},
      {"JustBelowAPower", {0, std::nextafter(1024.0F, 0.0F)}},
      {"AtAPower", {0, 1024}},
  };
}

class RangeHistogramTest : public testing::TestWithParam<Values> {};

TEST_P(RangeHistogramTest, AllValuesAtOnceMatchTheDefinition) {
  RangeHistogram histogram;
  EXPECT_TRUE(histogram.empty());
  add(histogram, GetParam().values);
  EXPECT_FALSE(histogram.empty());
  expect_histogram(histogram, expected_histogram(GetParam().values));
}

TEST_P(RangeHistogramTest, IsTheSameInAnyOrderAndPartition) {
  const Expected expected = expected_histogram(GetParam().values);
  std::mt19937 random(11);
  for (const std::size_t parts : {1U, 2U, 5U, 30U}) {
    std::vector<float> values = GetParam().values;
    std::shuffle(values.begin(), values.end(), random);
    std::vector<RangeHistogram> histograms(parts);
    RangeHistogram sequential;
    for (std::size_t at = 0; at < values.size();) {
      const std::size_t count = std::min<std::size_t>(values.size() - at, random() % 900 + 1);
      const std::span<const float> piece(values.data() + at, count);
      add(histograms[random() % parts], piece);
      add(sequential, piece);
      at += count;
    }
    expect_histogram(sequential, expected);
    // The histograms are merged as a tree and as a list, including empty ones.
    RangeHistogram list;
    for (const RangeHistogram& h : histograms) list.merge(h);
    expect_histogram(list, expected);
    while (histograms.size() > 1) {
      const RangeHistogram last = histograms.back();
      histograms.pop_back();
      histograms[random() % histograms.size()].merge(last);
    }
    expect_histogram(histograms[0], expected);
  }
}

TEST_P(RangeHistogramTest, RestoredHistogramContinuesUnchanged) {
  const std::vector<float>& values = GetParam().values;
  const std::size_t half = values.size() / 2;
  RangeHistogram histogram;
  if (half > 0) add(histogram, std::span(values).first(half));
  RangeHistogram restored = RangeHistogram::restored(histogram.exponent(), histogram.base(), histogram.counts());
  RangeHistogram merged = restored;
  add(restored, std::span(values).subspan(half));
  expect_histogram(restored, expected_histogram(values));
  RangeHistogram rest;
  add(rest, std::span(values).subspan(half));
  merged.merge(rest);
  expect_histogram(merged, expected_histogram(values));
}

TEST_P(RangeHistogramTest, IsTheSameValueByValue) {
  RangeHistogram histogram;
  for (const float v : GetParam().values) histogram.add(v, 3);
  Expected expected = expected_histogram(GetParam().values);
  for (std::uint64_t& count : expected.counts) count *= 3;
  expect_histogram(histogram, expected);
}

TEST_P(RangeHistogramTest, HasEdgesAtMultiplesOfTheWidthAndEveryValueInItsBin) {
  RangeHistogram histogram;
  const auto& values = GetParam().values;
  add(histogram, values);
  const double width = histogram.bin_width();
  EXPECT_EQ(std::fmod(histogram.first_edge(), width), 0);
  EXPECT_EQ(std::ldexp(1.0, std::ilogb(width)), width);
  const std::size_t bins = histogram.counts().size();
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  if (*low == *high) {
    EXPECT_EQ(bins, 1U);
  } else if (width > 0x1p-149) {
    EXPECT_GE(bins, 513U);
  }
  EXPECT_LE(bins, RangeHistogram::kMaxBins);
  for (const float v : values) {
    const std::size_t bin = histogram.bin_of(v);
    ASSERT_LT(bin, bins);
    // These comparisons are exact, because edges are representable if a value lies in the bin.
    EXPECT_LE(histogram.first_edge() + static_cast<double>(bin) * width, static_cast<double>(v));
    EXPECT_GE(histogram.first_edge() + static_cast<double>(bin + 1) * width, static_cast<double>(v));
  }
}

INSTANTIATE_TEST_SUITE_P(Values, RangeHistogramTest, testing::ValuesIn(value_sets()),
                         [](const auto& parameter) { return parameter.param.name; });

TEST(RangeHistogram, CountsOfZeroChangeNothing) {
  RangeHistogram histogram;
  histogram.add(1e30F, 0);
  EXPECT_TRUE(histogram.empty());
  EXPECT_TRUE(histogram.counts().empty());
  histogram.merge(RangeHistogram());
  EXPECT_TRUE(histogram.empty());
  histogram.add(2.0F, 5);
  histogram.merge(RangeHistogram());
  EXPECT_EQ(histogram.counts(), (std::vector<std::uint64_t>{5}));
}

TEST(RangeHistogram, CountsBeyond32Bits) {
  RangeHistogram histogram;
  histogram.add(2.0F, std::uint64_t{1} << 40U);
  RangeHistogram other;
  other.add(2.0F, std::uint64_t{1} << 41U);
  histogram.merge(other);
  EXPECT_EQ(histogram.counts(), (std::vector<std::uint64_t>{std::uint64_t{3} << 40U}));
}

TEST(RangeHistogram, FullRangeOfFloat) {
  RangeHistogram histogram;
  const float max = std::numeric_limits<float>::max();
  add(histogram, std::vector<float>{-max, max});
  EXPECT_EQ(histogram.bin_width(), 0x1p119);
  EXPECT_EQ(histogram.first_edge(), -0x1p128);
  EXPECT_EQ(histogram.counts().size(), 1024U);
}

TEST(RangeHistogram, HasNoNegativeZeroForAnEdge) {
  RangeHistogram histogram;
  add(histogram, std::vector<float>{-0.0F, 0.0F});
  EXPECT_FALSE(std::signbit(histogram.base()));
  EXPECT_FALSE(std::signbit(histogram.first_edge()));
}

}  // namespace
}  // namespace weir::range_histogram_test
