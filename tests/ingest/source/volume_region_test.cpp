#include "ingest/source/volume_region.h"

#include <gtest/gtest.h>

namespace weir::volume_region_test {
namespace {

constexpr Box kDomain{{0, 0, 0}, {10, 8, 6}};

TEST(VolumeRegion, EndsLeftOut_AreTheVolumesOwn) {
  VolumeRegion region;
  EXPECT_EQ(region.in(kDomain), kDomain);
  region.first[0] = 3;
  region.end[2] = 5;
  EXPECT_EQ(region.in(kDomain), (Box{{3, 0, 0}, {10, 8, 5}}));
}

TEST(VolumeRegion, EndsBelow0_CountFromTheVolumesEnd) {
  VolumeRegion region;
  region.first = {-4, std::nullopt, 1};
  region.end = {std::nullopt, -1, -2};
  EXPECT_EQ(region.in(kDomain), (Box{{6, 0, 1}, {10, 7, 4}}));
  EXPECT_EQ(VolumeRegion(Box{{-11, 0, 0}, {9, 8, 6}}).in(kDomain), (Box{{-1, 0, 0}, {9, 8, 6}}))
      << "outside stays outside";
}

TEST(VolumeRegion, EndsBelow0_AreIndicesWhereTheVolumeHasSuch) {
  const Box domain{{-5, 2, 0}, {5, 8, 6}};
  EXPECT_EQ(VolumeRegion(Box{{-3, -3, 0}, {-1, -1, 6}}).in(domain), (Box{{-3, 5, 0}, {-1, 7, 6}}));
}

}  // namespace
}  // namespace weir::volume_region_test
