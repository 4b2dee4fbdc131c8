// The error of a volume's gradient: central differences, at the faces of the volume those to the next voxel, as
// numpy.gradient has them.
#pragma once

#include <array>
#include <cstdint>

#include "compressor/compare/value_pair.h"
#include "compressor/leaf/exact_sum.h"
#include "format/sidecar/sidecar.h"

namespace weir {

using GradientError = Sidecar::GradientError;

/// For one thread; sums do not depend on order and grouping.
class GradientTally {
 public:
  GradientTally() = default;
  /// `spacing`: world units per voxel.
  explicit GradientTally(const std::array<double, 3>& spacing) : spacing_(spacing) {}

  /// The voxels `part`, a block of 8^3 cut to the volume; `values` has a voxel more on each side that the volume has.
  void add(const ValuePair& values, const Box& part);
  void merge(const GradientTally& other);
  GradientError result() const;

 private:
  std::array<double, 3> spacing_{1, 1, 1};
  ExactSum error_;
  ExactSum source_;
  double largest_ = 0;  // squared
  std::uint64_t voxels_ = 0;
  std::uint64_t left_out_ = 0;
};

}  // namespace weir
