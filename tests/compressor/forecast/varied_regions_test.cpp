#include "compressor/forecast/varied_regions.h"

#include <gtest/gtest.h>

namespace weir::varied_regions_test {
namespace {

TEST(VariedRegions, OfOneValue_AreNotCounted) {
  VariedRegions regions({{-130, 0, 0}, {256, 128, 128}});  // four regions, from -256 on
  EXPECT_EQ(regions.count(), 0U);
  regions.add({-130, 5, 5}, {1, 1});
  regions.add({-129, 127, 5}, {1, 1});
  regions.add({-1, 0, 0}, {2, 2});
  regions.add({0, 0, 0}, {2, 3});
  regions.add({255, 0, 0}, {4, 4});
  EXPECT_EQ(regions.count(), 1U);
  regions.add({128, 0, 0}, {5, 5});  // same region as 255
  EXPECT_EQ(regions.count(), 2U);
}

TEST(VariedRegions, OfWhichNothingWasSeen_VaryAsTheOthers) {
  VariedRegions regions({{0, 0, 0}, {128 * 8, 128, 128}});
  regions.add({0, 0, 0}, {0, 1});
  regions.add({200, 0, 0}, {0, 0});
  EXPECT_EQ(regions.count(), 4U);  // one of two varies, and there are eight
}

TEST(VariedRegions, OfWhichAllIsHidden_AreNotCounted) {
  VariedRegions regions({{0, 0, 0}, {128 * 4, 128, 128}});
  regions.add({0, 0, 0}, {0, 1});
  regions.add_hidden({200, 0, 0});
  EXPECT_EQ(regions.count(), 2U);  // one of two varies, and there are four
}

}  // namespace
}  // namespace weir::varied_regions_test
