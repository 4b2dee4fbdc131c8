#include "compressor/derived/gradient_error.h"

#include <algorithm>
#include <cmath>

#include "compressor/derived/neighbours.h"

namespace weir {

void GradientTally::add(const ValuePair& values, const Box& part) {
  double error = 0;
  double source = 0;
  for_each_index(part, [&](const Index3& i) {
    double of_error = 0;
    double of_source = 0;
    for (const auto& [low, high, length] : neighbours_of(values, i, spacing_)) {
      if (length == 0) continue;  // an axis of one voxel
      if (!values.finite(low) || !values.finite(high)) {
        ++left_out_;
        return;
      }
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
