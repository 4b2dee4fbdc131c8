// The uncertainty of a figure that comes from a sample.
#pragma once

#include <span>

namespace weir {

/// A figure, and the range in which it is expected.
struct Expected {
  double value = 0;
  double low = 0;
  double high = 0;
};

/// Returns `value` with its 95 % range. `value` comes from a sample of `share` (0..1) of the volume, `parts` from equal
/// parts of the sample, each spread over the volume as the sample is. The range is value - w to value + w with
/// w = t s sqrt((1 - share) / n). s is the standard deviation of the n parts, t the 97.5 % quantile of Student's
/// distribution with n - 1 degrees of freedom (random groups: Wolter, Introduction to Variance Estimation, chapter 2).
/// Fewer than two parts give no spread.
Expected spread_of(double value, std::span<const double> parts, double share);

}  // namespace weir
