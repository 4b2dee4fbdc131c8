// Structural similarity (Wang, Bovik, Sheikh, Simoncelli, "Image Quality Assessment", IEEE TIP 2004) of a volume and
// what a file reads, over windows in three dimensions.
#pragma once

#include <cstdint>
#include <optional>

#include "compressor/compare/value_pair.h"
#include "compressor/leaf/exact_sum.h"

namespace weir {

struct Similarity {
  std::uint64_t windows = 0;   ///< over which the mean is taken
  std::uint64_t left_out = 0;  ///< those with a value that is not finite
  std::optional<double> mean;  ///< none without a window, and of a volume of one value
};

/// Windows of 8^3 voxels, equally weighed, begin at every fourth voxel along each axis from the volume's lowest one,
/// and once more so that the last one ends with the axis; along an axis of less than 8 voxels there is one. C1 = (0.01
/// L)^2, C2 = (0.03 L)^2, L the range of the source; variances are divided by the number of voxels. For one thread;
/// sums do not depend on order and grouping.
class SimilarityTally {
 public:
  static constexpr std::int64_t kWindow = 8;
  static constexpr std::int64_t kStride = 4;

  /// `low`, `high`: the range of the source's finite values.
  SimilarityTally(double low, double high) : middle_((low + high) / 2), range_(high - low) {}

  /// The windows that begin in `part`, a block of 8^3 cut to the volume; `values` has 7 voxels more above each
  /// side that the volume has.
  void add(const ValuePair& values, const Box& part);
  void merge(const SimilarityTally& other);
  Similarity result() const;

 private:
  double middle_;
  double range_;
  ExactSum sum_;  // of 1 + SSIM of a window, which is not below 0
  std::uint64_t windows_ = 0;
  std::uint64_t left_out_ = 0;
};

}  // namespace weir
