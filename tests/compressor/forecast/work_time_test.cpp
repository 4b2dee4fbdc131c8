#include "compressor/forecast/work_time.h"

#include <gtest/gtest.h>

#include <array>

namespace weir::work_time_test {
namespace {

// A fixed time of 1 s, plus 2 s for each 100 voxels.
double exactly(double voxels) { return 1 + 0.02 * voxels; }

TEST(WorkTime, WhatEveryConversionTakes_IsCountedOnce) {
  const std::array<double, 4> parts{exactly(100), exactly(100), exactly(100), exactly(100)};
  EXPECT_NEAR(scaled_time(exactly(800), 800, parts, 100, 10000), exactly(10000), 1e-9);
}

TEST(WorkTime, OneSlowPart_DoesNotCount) {
  const std::array<double, 5> parts{exactly(100), 9, exactly(100), exactly(100), exactly(100)};
  EXPECT_NEAR(scaled_time(exactly(800), 800, parts, 100, 10000), exactly(10000), 1e-9);
}

TEST(WorkTime, WithoutUsefulParts_IsInProportion) {
  EXPECT_DOUBLE_EQ(scaled_time(3, 100, {}, 0, 1000), 30);
  const std::array<double, 2> slower{4, 4};
  EXPECT_DOUBLE_EQ(scaled_time(3, 100, slower, 10, 1000), 30);
  const std::array<double, 2> nothing{0, 0};  // time grows faster than voxels
  EXPECT_DOUBLE_EQ(scaled_time(3, 100, nothing, 10, 1000), 30);
}

TEST(WorkTime, PackedPartsOfFewBlocks_AreNotLikeTheVolume) {
  EXPECT_FALSE(are_like_volume(Encoding::packed, 16383 * 512.0));
  EXPECT_TRUE(are_like_volume(Encoding::packed, 16384 * 512.0));
  EXPECT_TRUE(are_like_volume(Encoding::automatic, 512.0));
}

TEST(WorkTime, Pass_WaitsForTheSlowerOfReadingAndWork) {
  EXPECT_DOUBLE_EQ(pass_time(5, 4, 1000, {0, 0, 4}), 5);
  EXPECT_DOUBLE_EQ(pass_time(5, 4, 1000, {0.012, 0, 4}), 12);
  EXPECT_DOUBLE_EQ(pass_time(5, 4, 1000, {0.004, 0.008, 4}), 5 + 8.0 / 4);  // decoding
}

}  // namespace
}  // namespace weir::work_time_test
