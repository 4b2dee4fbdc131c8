// The discrete Fourier transform of a block of real values, by FFTW.
#pragma once

#include <complex>
#include <memory>
#include <span>

#include "format/base/index.h"

namespace weir {

/// Transforms blocks of one extent. Only one thread at a time may make or free objects, because of FFTW's plans; any
/// number of threads may use one object.
class BlockTransform {
 public:
  /// `extent`: voxels, each at least 1. Throws Error(usage) in a build without FFTW.
  explicit BlockTransform(const Index3& extent);

  /// Returns the extent of the result of run(): extent.x / 2 + 1 along x; the other frequencies are the conjugates of
  /// these.
  static Index3 frequencies(const Index3& extent) { return {extent.x / 2 + 1, extent.y, extent.z}; }

  /// Computes the sums of value * exp(-2 pi i (m . n / extent)) over the voxels n, not scaled. Values and result are x
  /// fastest.
  void run(std::span<double> values, std::span<std::complex<double>> result) const;

 private:
  class Plan;
  std::shared_ptr<const Plan> plan_;
};

/// Returns whether this build has FFTW.
bool has_fftw();

}  // namespace weir
