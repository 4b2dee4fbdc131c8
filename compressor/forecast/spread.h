// How uncertain a figure of a sample is.
#pragma once

#include <span>

namespace weir {

/// A figure, and between which values it is to be expected.
struct Expected {
  double value = 0;
  double low = 0;
  double high = 0;
};

/// `value` is that of a sample of `share` (0..1) of the volume, `parts` are those of equal parts of the sample, each
/// spread over the volume as the sample is. From value - w to value + w, where w = t s sqrt((1 - share) / n): s is the
/// standard deviation of the n parts, t the 97.5 % quantile of Student's distribution with n - 1 degrees of freedom
/// (random groups: Wolter, Introduction to Variance Estimation, chapter 2). No spread for fewer than two parts.
Expected spread_of(double value, std::span<const double> parts, double share);

}  // namespace weir
