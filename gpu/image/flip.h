// FLIP: how different two pictures look to somebody who alternates between them. Andersson, Nilsson, Akenine-Moller,
// Oskarsson, Astrom and Fairchild, FLIP: A Difference Evaluator for Alternating Images, HPG 2020.
#pragma once

#include <span>
#include <vector>

#include "gpu/image/image.h"

namespace weir {

/// The authors' display: 3840 pixels over 0.7 m, seen from 0.7 m.
inline constexpr double kFlipPixelsPerDegree = 67.0206433;
inline constexpr double kFlipMinPixelsPerDegree = 1;
inline constexpr double kFlipMaxPixelsPerDegree = 1000;

/// The difference at every pixel, from 0 (none visible) to 1 (the largest possible), rows from the top. Colours count
/// as a display shows them: linear RGB is cut to [0, 1], NaN is black. Symmetric in the two pictures. The work is that
/// of separable filters, some 0.3 pixels_per_degree + 1 taps wide. Does not depend on the number of threads. Throws
/// Error(usage) where the sizes differ, there is no pixel, or pixels_per_degree is outside its range.
std::vector<float> flip_errors(const Image& reference, const Image& test, double pixels_per_degree);

/// The errors of all pixels in a few numbers. A weighted percentile is the error up to which the smaller errors
/// together make that share of the sum of all errors; 0 where that sum is.
struct FlipSummary {
  double mean = 0;
  double median = 0;
  double weighted_median = 0;
  double first_weighted_quartile = 0;
  double third_weighted_quartile = 0;
  double min = 0;
  double max = 0;

  friend bool operator==(const FlipSummary&, const FlipSummary&) = default;
};

/// `errors` of at least one pixel.
FlipSummary summarise_flip(std::span<const float> errors);

/// The errors as the colours of the map "magma", a 256th each.
Image flip_picture(std::span<const float> errors, std::int32_t width, std::int32_t height);

}  // namespace weir
