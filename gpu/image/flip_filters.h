// The one-dimensional filters that FLIP's two-dimensional ones are products of.
#pragma once

#include <cstddef>
#include <vector>

namespace weir {

/// Weights at whole pixels, of odd count, the centre in the middle; applied as a correlation.
using Filter1d = std::vector<float>;

inline std::size_t filter_radius(const Filter1d& filter) { return filter.size() / 2; }

/// Contrast sensitivity of the eye to each channel of an opponent colour space, as a low pass (Andersson et al. 2020,
/// section 4.1.1). Of one length; each filter along x and along y, and the two of blue-yellow summed, keeps a constant.
struct ContrastFilters {
  Filter1d achromatic;
  Filter1d red_green;
  Filter1d blue_yellow_narrow;
  Filter1d blue_yellow_wide;
};

/// A Gaussian and its derivatives (section 4.2.1). Of one length; `smooth` sums to 1, the positive weights of each
/// other filter to 1, the negative ones to -1.
struct FeatureFilters {
  Filter1d smooth;
  Filter1d edge;   ///< first derivative
  Filter1d point;  ///< second derivative
};

/// For a display of `pixels_per_degree` of visual angle, at least 1: narrower Gaussians are no longer representable.
ContrastFilters contrast_filters(double pixels_per_degree);
FeatureFilters feature_filters(double pixels_per_degree);

}  // namespace weir
