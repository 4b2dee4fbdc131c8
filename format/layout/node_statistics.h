// The statistics that NanoVDB keeps per node (min, max, mean, standard deviation
// of active values) and the active bounding box, combined in the order and with
// the arithmetic of its GridStats, so that stock tools rewrite them bit for bit.
// Method: Welford 1962 for single values, Chan et al. 1979 for merging.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "format/base/index.h"

namespace weir {

struct NodeStatistics {
  float min = std::numeric_limits<float>::max();
  float max = std::numeric_limits<float>::lowest();
  double mean = 0;
  double m2 = 0;                                              ///< sum of squared deviations from the mean
  std::uint64_t count = 0;                                    ///< active voxels
  Box bbox{{kNone, kNone, kNone}, {-kNone, -kNone, -kNone}};  ///< of active voxels; empty at first

  void add(float value) {
    extend(value, value);
    ++count;
    const double delta = static_cast<double>(value) - mean;
    mean += delta / static_cast<double>(count);
    m2 += delta * (static_cast<double>(value) - mean);
  }

  /// Adds a tile: `n` active voxels of one value.
  void add_tile(float value, std::uint64_t n, const Box& box) {
    const double denominator = 1.0 / static_cast<double>(count + n);
    const double delta = static_cast<double>(value) - mean;
    mean += denominator * delta * static_cast<double>(n);
    m2 += denominator * delta * delta * static_cast<double>(count) * static_cast<double>(n);
    extend(value, value);
    count += n;
    add_box(box);
  }

  /// Adds a child node.
  void add(const NodeStatistics& other) {
    if (other.count == 0) return;
    const double denominator = 1.0 / static_cast<double>(count + other.count);
    const double delta = other.mean - mean;
    mean += denominator * delta * static_cast<double>(other.count);
    m2 += other.m2 + denominator * delta * delta * static_cast<double>(count) * static_cast<double>(other.count);
    extend(other.min, other.max);
    count += other.count;
    add_box(other.bbox);
  }

  void add_box(const Box& box) {
    bbox.lo = weir::min(bbox.lo, box.lo);
    bbox.hi = weir::max(bbox.hi, box.hi);
  }

  float average() const { return static_cast<float>(mean); }
  float deviation() const { return static_cast<float>(count < 2 ? 0.0 : std::sqrt(m2 / static_cast<double>(count))); }

 private:
  static constexpr std::int64_t kNone = std::numeric_limits<std::int32_t>::max();

  // NaN compares false and so leaves the extrema as they are, as in the stock code.
  void extend(float low, float high) {
    if (low < min) min = low;
    if (high > max) max = high;
  }
};

}  // namespace weir
