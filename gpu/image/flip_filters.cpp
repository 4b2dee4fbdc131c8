#include "gpu/image/flip_filters.h"

#include <cmath>
#include <functional>
#include <numbers>

namespace weir {

namespace {

constexpr double kPiSquared = std::numbers::pi * std::numbers::pi;

/// One term of a contrast sensitivity function after the Fourier transform: a sqrt(pi / b) exp(-pi^2 r^2 / b), r in
/// degrees. a and b come from Andersson et al. 2020, table 1 (b in square degrees).
struct Sensitivity {
  double a;
  double b;
};
constexpr Sensitivity kAchromatic{1, 0.0047};
constexpr Sensitivity kRedGreen{1, 0.0053};
constexpr Sensitivity kBlueYellowWide{34.1, 0.04};
constexpr Sensitivity kBlueYellowNarrow{13.5, 0.025};
constexpr double kWidestB = 0.04;
/// Width of the features that the eye detects, in degrees (section 4.2.1).
constexpr double kFeatureWidth = 0.082;

std::vector<double> weights(double radius, const std::function<double(double)>& weight) {
  std::vector<double> values;
  for (double x = -radius; x <= radius; ++x) values.push_back(weight(x));
  return values;
}

double sum(const std::vector<double>& values) {
  double total = 0;
  for (const double v : values) total += v;
  return total;
}

Filter1d divided(const std::vector<double>& values, double divisor) {
  Filter1d filter;
  for (const double v : values) filter.push_back(static_cast<float>(v / divisor));
  return filter;
}

// Divides positive and negative weights by their own sums.
Filter1d divided_by_sign(const std::vector<double>& values) {
  double positive = 0;
  double negative = 0;
  for (const double v : values) (v > 0 ? positive : negative) += std::abs(v);
  Filter1d filter;
  for (const double v : values) filter.push_back(static_cast<float>(v / (v > 0 ? positive : negative)));
  return filter;
}

}  // namespace

ContrastFilters contrast_filters(double pixels_per_degree) {
  // Three standard deviations of the widest term; used for all terms.
  const double radius = std::ceil(3 * std::sqrt(kWidestB / (2 * kPiSquared)) * pixels_per_degree);
  // The square root of the factor, because a term in two dimensions is the product of this one along x and along y.
  const auto term = [&](const Sensitivity& s) {
    return weights(radius, [&](double x) {
      const double degrees = x / pixels_per_degree;
      return std::sqrt(s.a * std::sqrt(std::numbers::pi / s.b)) * std::exp(-kPiSquared * degrees * degrees / s.b);
    });
  };
  const std::vector<double> achromatic = term(kAchromatic);
  const std::vector<double> red_green = term(kRedGreen);
  const std::vector<double> narrow = term(kBlueYellowNarrow);
  const std::vector<double> wide = term(kBlueYellowWide);
  // The two products together sum to the square of this, so each filter is divided by it along each axis.
  const double both = std::hypot(sum(narrow), sum(wide));
  return {divided(achromatic, sum(achromatic)), divided(red_green, sum(red_green)), divided(narrow, both),
          divided(wide, both)};
}

FeatureFilters feature_filters(double pixels_per_degree) {
  const double deviation = kFeatureWidth / 2 * pixels_per_degree;
  const double radius = std::ceil(3 * deviation);
  const auto gaussian = [&](double x) { return std::exp(-x * x / (2 * deviation * deviation)); };
  const std::vector<double> smooth = weights(radius, gaussian);
  return {
      divided(smooth, sum(smooth)), divided_by_sign(weights(radius, [&](double x) { return -x * gaussian(x); })),
      divided_by_sign(weights(radius, [&](double x) { return (x * x / (deviation * deviation) - 1) * gaussian(x); }))};
}

}  // namespace weir
