#include "format/sidecar/valid_voxels.h"

#include <gtest/gtest.h>

namespace weir::valid_voxels_test {
namespace {

Sidecar lossless(std::uint64_t missing, const std::string& policy) {
  Sidecar s;
  s.source.extent = {10, 10, 10};
  s.error.lossless = true;
  s.budget.kind = "lossless";
  s.missing.count = missing;
  s.missing.policy = policy;
  return s;
}

TEST(ValidVoxels, AllOfAVolumeWithoutMissingOnes) {
  const Sidecar s = lossless(0, "error");
  EXPECT_EQ(valid_voxels(s), 1000U);
  EXPECT_EQ(lossless_text(s), "lossless");
  EXPECT_EQ(missing_text(s), "");
}

TEST(ValidVoxels, MissingUnderTheBackground_AreNotCountedAndNotLossless) {
  const Sidecar s = lossless(250, "background");
  EXPECT_EQ(valid_voxels(s), 750U);
  EXPECT_EQ(lossless_text(s), "lossless over valid voxels");
  EXPECT_EQ(missing_text(s), "250 of 1000 voxels (25 %) hold no data and read as the background");
}

TEST(ValidVoxels, MissingInALossyFile_ReadAsTheBackgroundOnlyInExactBlocks) {
  Sidecar s = lossless(250, "background");
  s.error.lossless = false;
  s.background.value = -1.23456;
  EXPECT_EQ(missing_text(s),
            "250 of 1000 voxels (25 %) hold no data; they read as the background, -1.235, only where a block is exact, "
            "and their error is not counted");
  s.missing.count = 1;
  EXPECT_EQ(missing_text(s),
            "1 of 1000 voxels (0.1 %) holds no data; it reads as the background, -1.235, only where a block is exact, "
            "and its error is not counted");
}

TEST(ValidVoxels, MissingInAFileThatIsLosslessByChance_MayReadAsTheirBlock) {
  Sidecar s = lossless(250, "background");
  s.budget.kind = "psnr";
  s.background.value = 100;
  EXPECT_EQ(lossless_text(s), "lossless over valid voxels");
  EXPECT_EQ(missing_text(s),
            "250 of 1000 voxels (25 %) hold no data; they read as the background, 100, or as the nearest value that "
            "their block holds");
}

TEST(ValidVoxels, OfALevel_MissingAreTheCellsThatAreNotItsOwn) {
  Sidecar s = lossless(250, "background");
  s.error.lossless = false;
  s.source.level = Sidecar::Level{0, 3};
  EXPECT_EQ(valid_voxels(s), 750U);
  EXPECT_EQ(missing_text(s), "250 of 1000 voxels (25 %) are not of this level, and inactive");
  s.missing.values = {"-999"};  // the count does not tell them apart
  EXPECT_EQ(missing_text(s), "250 of 1000 voxels (25 %) are not of this level or without data, and inactive");
  s.missing.count = 1;
  EXPECT_EQ(missing_text(s), "1 of 1000 voxels (0.1 %) is not of this level or without data, and inactive");
}

TEST(ValidVoxels, MissingKeptAsData_AreVoxelsLikeOthers) {
  const Sidecar s = lossless(1, "keep");
  EXPECT_EQ(valid_voxels(s), 1000U);
  EXPECT_EQ(lossless_text(s), "lossless");
  EXPECT_EQ(missing_text(s), "1 of 1000 voxels (0.1 %) holds no data and is kept as data");
}

TEST(ValidVoxels, MissingThatBecameNaN_AreNotLossless) {
  const Sidecar s = lossless(2, "nan");
  EXPECT_EQ(lossless_text(s), "lossless over valid voxels");
  EXPECT_EQ(missing_text(s), "2 of 1000 voxels (0.2 %) hold no data and read NaN");
}

TEST(ValidVoxels, SidecarsOfOlderVersions_TookTheBackgroundUnlessNaNWasKept) {
  Sidecar s = lossless(2, "");
  EXPECT_EQ(missing_text(s), "2 of 1000 voxels (0.2 %) hold no data and read as the background");
  s.nonfinite.policy = "keep";
  EXPECT_EQ(missing_text(s), "2 of 1000 voxels (0.2 %) hold no data and read NaN");
}

TEST(ValidVoxels, NaNReplacedByTheBackground_IsNotLossless) {
  Sidecar s = lossless(0, "background");
  s.nonfinite = {3, "background"};
  EXPECT_EQ(valid_voxels(s), 997U);
  EXPECT_FALSE(lossless_everywhere(s));
  EXPECT_EQ(nonfinite_text(s), "3 of 1000 voxels (0.3 %) are NaN or infinite and read as the background");
  s.error.lossless = false;
  EXPECT_EQ(nonfinite_text(s),
            "3 of 1000 voxels (0.3 %) are NaN or infinite; they read as the background, 0, only where a block is "
            "exact, and their error is not counted");
  s.error.lossless = true;
  s.nonfinite.policy = "keep";
  EXPECT_TRUE(lossless_everywhere(s));
  EXPECT_EQ(nonfinite_text(s), "");
}

TEST(ValidVoxels, LostZerosAreSaidWithTheirShare) {
  EXPECT_EQ(lost_zeros_text(76109, 1727781), "76109 of 1727781 zeros (4.4 %) lost");
  EXPECT_EQ(lost_zeros_text(0, 1727781), "");
}

}  // namespace
}  // namespace weir::valid_voxels_test
