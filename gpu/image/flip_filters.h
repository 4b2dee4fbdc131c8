// The one-dimensional filters whose products are FLIP's two-dimensional filters.
#pragma once

#include <cstddef>
#include <vector>

namespace weir {

/// Weights at whole pixels. Their count is odd and the centre is in the middle. Applied as a correlation.
using Filter1d = std::vector<float>;

inline std::size_t filter_radius(const Filter1d& filter) { return filter.size() / 2; }

/// The eye's contrast sensitivity to each channel of an opponent colour space, as a low pass (Andersson et al. 2020,
/// section 4.1.1). All filters have the same length. Each filter along x and y keeps a constant picture; of
/// blue-yellow, the sum of the two filters does.
struct ContrastFilters {
  Filter1d achromatic;
  Filter1d red_green;
  Filter1d blue_yellow_narrow;
  Filter1d blue_yellow_wide;
};

/// A Gaussian and its derivatives (section 4.2.1), all of the same length. `smooth` sums to 1. In each other filter
/// the positive weights sum to 1 and the negative weights to -1.
struct FeatureFilters {
  Filter1d smooth;
  Filter1d edge;   ///< first derivative
  Filter1d point;  ///< second derivative
};

/// For a display with `pixels_per_degree` of visual angle, at least 1: narrower Gaussians cannot be represented.
ContrastFilters contrast_filters(double pixels_per_degree);
FeatureFilters feature_filters(double pixels_per_degree);

}  // namespace weir
