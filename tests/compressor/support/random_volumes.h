// Volumes for property tests: drawn from the distributions that estimates of error fail on.
#pragma once

#include <cstdint>
#include <string>

#include "tests/compressor/support/memory_volume.h"

namespace weir::test {

struct RandomVolume {
  std::string name;  ///< distribution, extent and seed: enough to make it again
  MemoryVolume volume;
  double range = 0;
};

/// The same for the same seed: heavy tails (Pareto, Cauchy, log-normal), spikes on small noise, sparse values, values
/// near or beside a lattice, smooth fields; 16 to `most` voxels along an axis.
RandomVolume random_volume(std::uint64_t seed, std::int64_t most);

/// How many volumes a property test looks at: what WEIR_PROPERTY_VOLUMES says, else `ordinary`.
std::uint64_t property_volumes(std::uint64_t ordinary);

}  // namespace weir::test
