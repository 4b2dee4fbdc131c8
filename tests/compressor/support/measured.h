// Measures a file with the stock reader, and compares the result with the source volume and with the file's
// certificate.
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

/// Reads every voxel and sums in long double over the finite voxels. Expects that the stock validator passes and that
/// the bounding box is the domain.
Measured measure(const MemoryVolume& volume, const Converted& converted, NonFinitePolicy policy);

/// Expects that the certificate agrees with `measured` to a relative 1e-12, and bit for bit in the largest error. For
/// quantised leaves the certificate gives the largest error rounded up to float.
void expect_certificate(const Converted& converted, const Measured& measured);

}  // namespace weir::test
