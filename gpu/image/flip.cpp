#include "gpu/image/flip.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "format/base/error.h"
#include "format/base/text.h"
#include "gpu/image/colormap.h"
#include "gpu/image/flip_color.h"
#include "gpu/image/flip_filters.h"

namespace weir {

namespace {

using Row = std::vector<float>;

// Computes sum_i filter[i] padded[x + i] for every x of `out`.
void filter_along(const Row& padded, const Filter1d& filter, float* out, std::size_t width) {
  std::fill_n(out, width, 0.0F);
  for (std::size_t i = 0; i < filter.size(); ++i) {
    const float weight = filter[i];
    const float* in = padded.data() + i;
    for (std::size_t x = 0; x < width; ++x) out[x] += weight * in[x];
  }
}

/// Consecutive rows of one channel.
class Rows {
 public:
  Rows(std::size_t width, std::size_t count) : width_(width), values_(width * count) {}
  float* row(std::size_t y) { return values_.data() + y * width_; }
  const float* row(std::size_t y) const { return values_.data() + y * width_; }

  // Computes sum_i filter[i] row(y + i): the column filter centred at row y + radius.
  void filter_across(std::size_t y, const Filter1d& filter, Row& out) const {
    std::fill(out.begin(), out.end(), 0.0F);
    for (std::size_t i = 0; i < filter.size(); ++i) {
      const float weight = filter[i];
      const float* in = row(y + i);
      for (std::size_t x = 0; x < width_; ++x) out[x] += weight * in[x];
    }
  }

 private:
  std::size_t width_;
  std::vector<float> values_;
};

float displayed(float linear) { return linear > 0 ? std::min(linear, 1.0F) : 0; }

struct Filters {
  ContrastFilters contrast;
  FeatureFilters feature;

  std::size_t radius() const { return std::max(filter_radius(contrast.achromatic), filter_radius(feature.smooth)); }
};

/// The rows [first, last) of a picture and the rows around them that the filters reach, filtered along x. Outside its
/// edges a picture continues with its edge pixels.
class Band {
 public:
  Band(const Image& image, const Filters& filters, std::int32_t first, std::int32_t last)
      : filters_(filters),
        width_(static_cast<std::size_t>(image.width)),
        margin_(filters.radius()),
        contrast_(4, Rows(width_, static_cast<std::size_t>(last) - static_cast<std::size_t>(first) + 2 * margin_)),
        feature_(3, contrast_[0]) {
    const auto reach = static_cast<std::int32_t>(margin_);
    for (std::int32_t y = first - reach; y < last + reach; ++y) {
      filter_row(image, std::clamp(y, 0, image.height - 1), static_cast<std::size_t>(y - first + reach));
    }
  }

  /// Returns hunt_lab of the filtered picture in row `first` + y.
  void perceived(std::size_t y, std::vector<Float3>& lab) {
    const ContrastFilters& f = filters_.contrast;
    const std::size_t top = y + margin_ - filter_radius(f.achromatic);
    contrast_[0].filter_across(top, f.achromatic, scratch(0));
    contrast_[1].filter_across(top, f.red_green, scratch(1));
    contrast_[2].filter_across(top, f.blue_yellow_narrow, scratch(2));
    contrast_[3].filter_across(top, f.blue_yellow_wide, scratch(3));
    for (std::size_t x = 0; x < width_; ++x) {
      const Float3 rgb = linear_from_opponent({scratch_[0][x], scratch_[1][x], scratch_[2][x] + scratch_[3][x]});
      lab[x] = hunt_lab({displayed(rgb.x), displayed(rgb.y), displayed(rgb.z)});
    }
  }

  /// Calculates the lengths of the gradient and of the second derivatives along x and y in row `first` + y, as
  /// smoothed by the eye.
  void features(std::size_t y, Row& edges, Row& points) {
    const FeatureFilters& f = filters_.feature;
    const std::size_t top = y + margin_ - filter_radius(f.smooth);
    feature_[1].filter_across(top, f.smooth, scratch(0));
    feature_[0].filter_across(top, f.edge, scratch(1));
    feature_[2].filter_across(top, f.smooth, scratch(2));
    feature_[0].filter_across(top, f.point, scratch(3));
    for (std::size_t x = 0; x < width_; ++x) {
      edges[x] = std::sqrt(scratch_[0][x] * scratch_[0][x] + scratch_[1][x] * scratch_[1][x]);
      points[x] = std::sqrt(scratch_[2][x] * scratch_[2][x] + scratch_[3][x] * scratch_[3][x]);
    }
  }

 private:
  void filter_row(const Image& image, std::int32_t source, std::size_t row) {
    // Four padded rows: Y, Cx, Cz, and Y scaled to [0, 1] for the features.
    const std::size_t contrast_pad = filter_radius(filters_.contrast.achromatic);
    const std::size_t feature_pad = filter_radius(filters_.feature.smooth);
    Row y(width_ + 2 * contrast_pad);
    Row cx = y;
    Row cz = y;
    Row gray(width_ + 2 * feature_pad);
    for (std::size_t x = 0; x < width_; ++x) {
      const Float3& p = image.at(static_cast<std::int32_t>(x), source);
      const Float3 opponent = opponent_from_linear({displayed(p.x), displayed(p.y), displayed(p.z)});
      y[contrast_pad + x] = opponent.x;
      cx[contrast_pad + x] = opponent.y;
      cz[contrast_pad + x] = opponent.z;
      gray[feature_pad + x] = (opponent.x + 16) / 116;
    }
    for (Row* padded : {&y, &cx, &cz}) continue_edges(*padded, contrast_pad);
    continue_edges(gray, feature_pad);
    filter_along(y, filters_.contrast.achromatic, contrast_[0].row(row), width_);
    filter_along(cx, filters_.contrast.red_green, contrast_[1].row(row), width_);
    filter_along(cz, filters_.contrast.blue_yellow_narrow, contrast_[2].row(row), width_);
    filter_along(cz, filters_.contrast.blue_yellow_wide, contrast_[3].row(row), width_);
    filter_along(gray, filters_.feature.smooth, feature_[0].row(row), width_);
    filter_along(gray, filters_.feature.edge, feature_[1].row(row), width_);
    filter_along(gray, filters_.feature.point, feature_[2].row(row), width_);
  }

  static void continue_edges(Row& padded, std::size_t pad) {
    std::fill_n(padded.begin(), pad, padded[pad]);
    std::fill_n(padded.end() - static_cast<std::ptrdiff_t>(pad), pad, padded[padded.size() - pad - 1]);
  }

  Row& scratch(std::size_t i) {
    scratch_[i].resize(width_);
    return scratch_[i];
  }

  const Filters& filters_;
  std::size_t width_;
  std::size_t margin_;
  std::vector<Rows> contrast_;  // filtered along x: achromatic, red-green, blue-yellow narrow and wide
  std::vector<Rows> feature_;   // smooth, edge, point
  std::array<Row, 4> scratch_;
};

void compare_band(const Image& reference, const Image& test, const Filters& filters, std::int32_t first,
                  std::int32_t last, std::vector<float>& errors) {
  Band a(reference, filters, first, last);
  Band b(test, filters, first, last);
  const auto width = static_cast<std::size_t>(reference.width);
  std::array<std::vector<Float3>, 2> lab{std::vector<Float3>(width), std::vector<Float3>(width)};
  std::array<Row, 2> edges{Row(width), Row(width)};
  std::array<Row, 2> points = edges;
  for (std::int32_t y = first; y < last; ++y) {
    const auto row = static_cast<std::size_t>(y - first);
    a.perceived(row, lab[0]);
    b.perceived(row, lab[1]);
    a.features(row, edges[0], points[0]);
    b.features(row, edges[1], points[1]);
    float* out = errors.data() + reference.index(0, y);
    for (std::size_t x = 0; x < width; ++x) {
      const float color = redistributed(hyab_difference(lab[0][x], lab[1][x]));
      const float feature =
          std::max(std::abs(edges[0][x] - edges[1][x]), std::abs(points[0][x] - points[1][x])) / std::sqrt(2.0F);
      out[x] = std::pow(color, 1 - std::sqrt(std::min(feature, 1.0F)));
    }
  }
}

}  // namespace

std::vector<float> flip_errors(const Image& reference, const Image& test, double pixels_per_degree) {
  if (reference.width != test.width || reference.height != test.height) {
    throw Error(ErrorKind::usage, cat("pictures of ", reference.width, " x ", reference.height, " and ", test.width,
                                      " x ", test.height, " pixels; give two of one size"));
  }
  if (reference.pixels.empty()) throw Error(ErrorKind::usage, "pictures without a pixel; give some");
  if (!(pixels_per_degree >= kFlipMinPixelsPerDegree && pixels_per_degree <= kFlipMaxPixelsPerDegree)) {
    throw Error(ErrorKind::usage, cat(pixels_per_degree, " pixels per degree; give ", kFlipMinPixelsPerDegree, " to ",
                                      kFlipMaxPixelsPerDegree));
  }
  const Filters filters{contrast_filters(pixels_per_degree), feature_filters(pixels_per_degree)};
  // Small enough for the cache. Large enough that the rows around it, which the next band filters again, cost little.
  const std::int32_t band = 32 + 2 * static_cast<std::int32_t>(filters.radius());
  std::vector<float> errors(reference.pixels.size());
  tbb::parallel_for(0, (reference.height + band - 1) / band, [&](std::int32_t i) {
    compare_band(reference, test, filters, i * band, std::min((i + 1) * band, reference.height), errors);
  });
  return errors;
}

FlipSummary summarise_flip(std::span<const float> errors) {
  std::vector<float> sorted(errors.begin(), errors.end());
  std::sort(sorted.begin(), sorted.end());
  double total = 0;
  for (const float e : sorted) total += e;
  const auto weighted = [&](double share) {
    double sum = 0;
    for (const float e : sorted) {
      sum += e;
      if (sum > share * total) return static_cast<double>(e);
    }
    return 0.0;
  };
  const std::size_t half = sorted.size() / 2;
  const double median = sorted.size() % 2 == 1 ? sorted[half] : (double{sorted[half - 1]} + sorted[half]) / 2;
  return {total / static_cast<double>(sorted.size()),
          median,
          weighted(0.5),
          weighted(0.25),
          weighted(0.75),
          sorted.front(),
          sorted.back()};
}

Image flip_picture(std::span<const float> errors, std::int32_t width, std::int32_t height) {
  const std::vector<Float3> colors = colormap("magma", 256);
  Image image(width, height);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    image.pixels[i] = colors[static_cast<std::size_t>(std::lround(std::min(errors[i], 1.0F) * 255))];
  }
  return image;
}

}  // namespace weir
