#include "compressor/derived/gradient_error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace weir {
namespace {

/// The two voxels along an axis between which a difference is taken, and the length from one to the other.
struct Neighbours {
  std::size_t low;
  std::size_t high;
  double length;
};

Neighbours neighbours(const ValuePair& values, const Index3& i, const Index3& step, bool at_low, bool at_high,
                      double spacing) {
  const int voxels = (at_low ? 0 : 1) + (at_high ? 0 : 1);
  return {values.at(at_low ? i : i - step), values.at(at_high ? i : i + step), spacing * voxels};
}

}  // namespace

void GradientTally::add(const ValuePair& values, const Box& part) {
  double error = 0;
  double source = 0;
  const Index3 last = values.domain.hi - Index3{1, 1, 1};
  const Index3& first = values.domain.lo;
  for_each_index(part, [&](const Index3& i) {
    const std::array<Neighbours, 3> axes{neighbours(values, i, {1, 0, 0}, i.x == first.x, i.x == last.x, spacing_[0]),
                                         neighbours(values, i, {0, 1, 0}, i.y == first.y, i.y == last.y, spacing_[1]),
                                         neighbours(values, i, {0, 0, 1}, i.z == first.z, i.z == last.z, spacing_[2])};
    double of_error = 0;
    double of_source = 0;
    for (const auto& [low, high, length] : axes) {
      if (!values.finite(low) || !values.finite(high)) {
        ++left_out_;
        return;
      }
      if (length == 0) continue;  // an axis of one voxel
      const double e = (values.error(high) - values.error(low)) / length;
      const double s = (static_cast<double>(values.source[high]) - static_cast<double>(values.source[low])) / length;
      of_error += e * e;
      of_source += s * s;
    }
    ++voxels_;
    error += of_error;
    source += of_source;
    largest_ = std::max(largest_, of_error);
  });
  error_.add(error);
  source_.add(source);
}

void GradientTally::merge(const GradientTally& other) {
  error_.add(other.error_);
  source_.add(other.source_);
  largest_ = std::max(largest_, other.largest_);
  voxels_ += other.voxels_;
  left_out_ += other.left_out_;
}

GradientError GradientTally::result() const {
  GradientError all;
  all.voxels = voxels_;
  all.left_out = left_out_;
  all.max_abs = std::sqrt(largest_);
  if (voxels_ == 0) return all;
  all.rms = std::sqrt(error_.value() / static_cast<double>(voxels_));
  if (source_.value() > 0) all.relative_rms = std::sqrt(error_.value() / source_.value());
  return all;
}

}  // namespace weir
