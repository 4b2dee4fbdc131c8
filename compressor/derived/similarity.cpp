#include "compressor/derived/similarity.h"

#include <algorithm>

#include "compressor/compare/window_begins.h"

namespace weir {
namespace {

WindowBegins windows_along(std::int64_t extent) {
  return {extent, std::min(extent, SimilarityTally::kWindow), std::min(extent, SimilarityTally::kStride)};
}

/// Sums over a window. The middle of the range is subtracted from all values to keep differences of squares small.
struct WindowSums {
  double a = 0;
  double b = 0;
  double aa = 0;
  double bb = 0;
  double ab = 0;
  std::int64_t voxels = 0;
  bool finite = true;

  void add(double x, double y) {
    a += x;
    b += y;
    aa += x * x;
    bb += y * y;
    ab += x * y;
  }

  double similarity(double middle, double range) const {
    const auto n = static_cast<double>(voxels);
    const double mean_a = a / n;
    const double mean_b = b / n;
    const double variance_a = std::max(aa / n - mean_a * mean_a, 0.0);
    const double variance_b = std::max(bb / n - mean_b * mean_b, 0.0);
    const double covariance = ab / n - mean_a * mean_b;
    const double c1 = 0.01 * range * 0.01 * range;
    const double c2 = 0.03 * range * 0.03 * range;
    const double x = mean_a + middle;
    const double y = mean_b + middle;
    return (2 * x * y + c1) * (2 * covariance + c2) / ((x * x + y * y + c1) * (variance_a + variance_b + c2));
  }
};

}  // namespace

void SimilarityTally::add(const ValuePair& values, const Box& part) {
  if (!(range_ > 0)) return;
  const Index3& lo = values.domain.lo;
  const Index3 extent = values.domain.extent();
  const VolumeWindows windows{windows_along(extent.x), windows_along(extent.y), windows_along(extent.z)};
  double sum = 0;
  for_each_index(windows.in({part.lo - lo, part.hi - lo}), [&](const Index3& number) {
    const Index3 corner = lo + windows.at(number);
    const Box window = intersect({corner, corner + Index3{kWindow, kWindow, kWindow}}, values.domain);
    WindowSums sums;
    sums.voxels = window.voxels();
    for_each_index(window, [&](const Index3& i) {
      const std::size_t at = values.at(i);
      sums.finite = sums.finite && values.finite(at);
      sums.add(static_cast<double>(values.source[at]) - middle_, static_cast<double>(values.decoded[at]) - middle_);
    });
    if (!sums.finite) {
      ++left_out_;
      return;
    }
    ++windows_;
    sum += 1 + std::clamp(sums.similarity(middle_, range_), -1.0, 1.0);
  });
  sum_.add(sum);
}

void SimilarityTally::merge(const SimilarityTally& other) {
  sum_.add(other.sum_);
  windows_ += other.windows_;
  left_out_ += other.left_out_;
}

Similarity SimilarityTally::result() const {
  Similarity all;
  all.windows = windows_;
  all.left_out = left_out_;
  if (windows_ > 0) all.mean = sum_.value() / static_cast<double>(windows_) - 1;
  return all;
}

}  // namespace weir
