// What the stock reader finds in a file, held against the volume it was made
// from and against what its certificate says.
#pragma once

#include <cstdint>

#include "tests/compressor/support/converted.h"

namespace weir::test {

struct Measured {
  std::uint64_t finite = 0;
  double mse = 0;
  double max_abs = 0;
  bool lossless = true;
  float min = 0;
  float max = 0;
};

/// Reads every voxel; sums in long double over the finite ones. Expects the stock validator to pass and the bounding
/// box to be the domain.
Measured measure(const MemoryVolume& volume, const Converted& converted, NonFinitePolicy policy);

/// Expects the certificate to say what was measured, to a relative 1e-12; the largest error to the bit, but for
/// quantised leaves, which give it rounded up to float.
void expect_certificate(const Converted& converted, const Measured& measured);

}  // namespace weir::test
