#include "compressor/derived/error_histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace weir {
namespace {

TEST(ErrorHistogram, QuantilesAreAtMostABinAboveTheSortedOnes) {
  std::mt19937 random(3);
  std::lognormal_distribution<double> sizes(-20, 6);
  std::vector<double> all;
  ErrorHistogram histogram;
  for (int i = 0; i < 20000; ++i) {
    all.push_back(sizes(random));
    histogram.add(all.back());
  }
  std::sort(all.begin(), all.end());
  for (const double share : {0.0001, 0.5, 0.9, 0.99, 0.999, 1.0}) {
    const double exact = all[static_cast<std::size_t>(std::ceil(share * 20000)) - 1];
    const double found = histogram.quantile(share, all.back());
    EXPECT_GE(found, exact) << share;
    EXPECT_LE(found, exact * (1 + 1.0 / 256)) << share;
  }
  EXPECT_EQ(histogram.quantile(1.0, all.back()), all.back());
}

TEST(ErrorHistogram, ZerosAndTheEndsOfTheRange) {
  ErrorHistogram histogram;
  EXPECT_EQ(histogram.quantile(0.5, 0), 0);
  for (int i = 0; i < 3; ++i) histogram.add(0);
  histogram.add(std::numeric_limits<float>::denorm_min());
  histogram.add(2.0 * static_cast<double>(std::numeric_limits<float>::max()));
  EXPECT_EQ(histogram.count(), 5U);
  EXPECT_EQ(histogram.quantile(0.6, 1e39), 0);
  EXPECT_LE(histogram.quantile(0.8, 1e39), 1.01 * 0x1p-149);
  const ErrorHistogram::Octaves octaves = histogram.octaves();
  EXPECT_EQ(octaves.zeros, 3U);
  EXPECT_EQ(octaves.first, -149);
  EXPECT_EQ(octaves.counts.size(), 149U + 129U);
  EXPECT_EQ(octaves.counts.front(), 1U);
  EXPECT_EQ(octaves.counts.back(), 1U);
}

TEST(ErrorHistogram, OctavesOfSizes) {
  ErrorHistogram a;
  ErrorHistogram b;
  for (const double size : {0.25, 0.3, 0.49, 0.5}) a.add(size);
  for (const double size : {1.0, 1.99, 2.0}) b.add(size);
  a.add(b);
  EXPECT_EQ(a.octaves().first, -2);
  EXPECT_EQ(a.octaves().counts, (std::vector<std::uint64_t>{3, 1, 2, 1}));
  EXPECT_TRUE(ErrorHistogram().octaves().counts.empty());
}

}  // namespace
}  // namespace weir
