// Structural similarity (Wang, Bovik, Sheikh, Simoncelli, "Image Quality Assessment", IEEE TIP 2004) of a volume and
// the decoded values of a file, over windows in three dimensions.
#pragma once

#include <cstdint>
#include <optional>

#include "compressor/compare/value_pair.h"
#include "compressor/leaf/exact_sum.h"

namespace weir {

struct Similarity {
  std::uint64_t windows = 0;   ///< windows in the mean
  std::uint64_t left_out = 0;  ///< windows left out because a value is not finite
  std::optional<double> mean;  ///< unset if there is no window, or if the volume has only one value
};

/// The tally of one thread. Windows have 8^3 voxels of equal weight. Along each axis they begin at every fourth voxel
/// from the volume's lowest one on, and an additional last window ends with the axis. An axis of less than 8 voxels has
/// one window. C1 = (0.01 L)^2 and C2 = (0.03 L)^2; L is the range of the source. Variances are divided by the number
/// of voxels. Sums do not depend on the order and the grouping of the parts.
class SimilarityTally {
 public:
  static constexpr std::int64_t kWindow = 8;
  static constexpr std::int64_t kStride = 4;

  /// `low` and `high` are the range of the source's finite values.
  SimilarityTally(double low, double high) : middle_((low + high) / 2), range_(high - low) {}

  /// Adds the windows that begin in `part`, a block of 8^3 cut to the volume. `values` has 7 voxels more above `part`
  /// along each axis, as far as the volume reaches.
  void add(const ValuePair& values, const Box& part);
  void merge(const SimilarityTally& other);
  Similarity result() const;

 private:
  double middle_;
  double range_;
  ExactSum sum_;  // sum over the windows of 1 + SSIM, which is never below 0
  std::uint64_t windows_ = 0;
  std::uint64_t left_out_ = 0;
};

}  // namespace weir
