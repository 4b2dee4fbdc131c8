// FLIP: how different two pictures look to a viewer who alternates between them. Andersson, Nilsson, Akenine-Moller,
// Oskarsson, Astrom and Fairchild, FLIP: A Difference Evaluator for Alternating Images, HPG 2020.
#pragma once

#include <span>
#include <vector>

#include "gpu/image/image.h"

namespace weir {

/// The authors' display: 3840 pixels over 0.7 m, seen from a distance of 0.7 m.
inline constexpr double kFlipPixelsPerDegree = 67.0206433;
inline constexpr double kFlipMinPixelsPerDegree = 1;
inline constexpr double kFlipMaxPixelsPerDegree = 1000;

/// Returns the difference at every pixel, from 0 (not visible) to 1 (the largest possible), rows from the top.
/// Colours are compared as a display shows them: linear RGB is clamped to [0, 1], NaN is black. Symmetric in the two
/// pictures. The work is that of separable filters, about 0.3 pixels_per_degree + 1 taps wide. The result does not
/// depend on the number of threads. Throws Error(usage) if the sizes differ, there is no pixel, or pixels_per_degree
/// is outside its range.
std::vector<float> flip_errors(const Image& reference, const Image& test, double pixels_per_degree);

/// The errors of all pixels in a few numbers. A weighted percentile is the error up to which the smaller errors add
/// up to that share of the sum of all errors; 0 if the sum is 0.
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

/// Summarises `errors` of at least one pixel.
FlipSummary summarise_flip(std::span<const float> errors);

/// Returns the errors as colours of the map "magma", in steps of 1/256.
Image flip_picture(std::span<const float> errors, std::int32_t width, std::int32_t height);

}  // namespace weir
