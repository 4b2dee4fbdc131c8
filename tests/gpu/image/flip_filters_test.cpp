#include "gpu/image/flip_filters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace weir::flip_filters_test {
namespace {

constexpr double kPpd = 67.0206433;

double sum(const Filter1d& filter) { return std::accumulate(filter.begin(), filter.end(), 0.0); }

double sum_of(const Filter1d& filter, float sign) {
  double total = 0;
  for (const float w : filter) total += w * sign > 0 ? w : 0.0;
  return total;
}

TEST(FlipFilters, Radii) {
  // ceil(3 sqrt(0.04 / (2 pi^2)) ppd) and ceil(3 * 0.041 ppd)
  EXPECT_EQ(filter_radius(contrast_filters(kPpd).achromatic), 10U);
  EXPECT_EQ(filter_radius(feature_filters(kPpd).smooth), 9U);
  EXPECT_EQ(filter_radius(contrast_filters(1).achromatic), 1U);
  EXPECT_EQ(filter_radius(feature_filters(1).smooth), 1U);
  EXPECT_EQ(filter_radius(contrast_filters(1000).achromatic), 136U);
  EXPECT_EQ(filter_radius(feature_filters(1000).smooth), 123U);
}

TEST(FlipFilters, KeepAConstant) {
  for (const double ppd : {1.0, 11.5, kPpd, 1000.0}) {
    const ContrastFilters contrast = contrast_filters(ppd);
    EXPECT_NEAR(sum(contrast.achromatic), 1, 1e-6) << ppd;
    EXPECT_NEAR(sum(contrast.red_green), 1, 1e-6) << ppd;
    const double narrow = sum(contrast.blue_yellow_narrow);
    const double wide = sum(contrast.blue_yellow_wide);
    EXPECT_NEAR(narrow * narrow + wide * wide, 1, 1e-6) << ppd;
    const FeatureFilters feature = feature_filters(ppd);
    EXPECT_NEAR(sum(feature.smooth), 1, 1e-6) << ppd;
    for (const Filter1d* filter : {&feature.edge, &feature.point}) {
      EXPECT_NEAR(sum_of(*filter, 1), 1, 1e-6) << ppd;
      EXPECT_NEAR(sum_of(*filter, -1), -1, 1e-6) << ppd;
    }
  }
}

TEST(FlipFilters, Shapes) {
  const FeatureFilters feature = feature_filters(kPpd);
  const std::size_t last = feature.edge.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    EXPECT_EQ(feature.smooth[i], feature.smooth[last - i]);
    EXPECT_EQ(feature.edge[i], -feature.edge[last - i]);
    EXPECT_EQ(feature.point[i], feature.point[last - i]);
  }
  EXPECT_EQ(feature.edge[9], 0);
  EXPECT_LT(feature.point[9], 0);
  // exp(-1 / (2 sigma^2)) from the centre to its neighbour, sigma = 0.041 ppd pixels
  EXPECT_NEAR(feature.smooth[10] / feature.smooth[9], std::exp(-1 / (2 * 2.7478464 * 2.7478464)), 1e-6);
  // exp(-pi^2 / (b ppd^2)), b = 0.0047
  const ContrastFilters contrast = contrast_filters(kPpd);
  EXPECT_NEAR(contrast.achromatic[11] / contrast.achromatic[10], std::exp(-9.8696044 / (0.0047 * kPpd * kPpd)), 1e-6);
  EXPECT_GT(contrast.blue_yellow_wide[0], contrast.blue_yellow_narrow[0]);
}

}  // namespace
}  // namespace weir::flip_filters_test
