// The discrete Fourier transform of a block of real values, by FFTW.
#pragma once

#include <complex>
#include <memory>
#include <span>

#include "format/base/index.h"

namespace weir {

/// Of blocks of one extent. Plans of FFTW are made and freed by one thread at a time; any threads may use one.
class BlockTransform {
 public:
  /// `extent`: voxels, each from 1 on. Throws Error(usage) in a build without FFTW.
  explicit BlockTransform(const Index3& extent);

  /// Of the frequencies that run() gives: extent.x / 2 + 1 along x, the others are their conjugates.
  static Index3 frequencies(const Index3& extent) { return {extent.x / 2 + 1, extent.y, extent.z}; }

  /// Sums of value * exp(-2 pi i (m . n / extent)) over the voxels n, not scaled. Both x fastest.
  void run(std::span<double> values, std::span<std::complex<double>> result) const;

 private:
  class Plan;
  std::shared_ptr<const Plan> plan_;
};

/// Whether this build has FFTW.
bool has_fftw();

}  // namespace weir
