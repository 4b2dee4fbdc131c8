// The error of a volume's gradient. The gradient uses central differences, and at the faces of the volume differences
// to the next voxel, as numpy.gradient does.
#pragma once

#include <array>
#include <cstdint>

#include "compressor/compare/value_pair.h"
#include "compressor/leaf/exact_sum.h"
#include "format/sidecar/sidecar.h"

namespace weir {

using GradientError = Sidecar::GradientError;

/// The tally of one thread. Sums do not depend on the order and the grouping of the parts.
class GradientTally {
 public:
  GradientTally() = default;
  /// `spacing` is in world units per voxel.
  explicit GradientTally(const std::array<double, 3>& spacing) : spacing_(spacing) {}

  /// Adds the voxels `part`, a block of 8^3 cut to the volume. `values` has one voxel more on each side, as far as the
  /// volume reaches.
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
