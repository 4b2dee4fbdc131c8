// Random volumes for property tests, drawn from distributions that estimates of error fail on.
#pragma once

#include <cstdint>
#include <string>

#include "tests/compressor/support/memory_volume.h"

namespace weir::test {

struct RandomVolume {
  std::string name;  ///< distribution, extent and seed, which suffice to make the volume again
  MemoryVolume volume;
  double range = 0;
};

/// Returns a random volume, which is the same for the same seed: heavy tails (Pareto, Cauchy, log-normal), spikes on
/// small noise, sparse values, values near or beside a lattice, or a smooth field. It has 16 to `most` voxels along
/// each axis.
RandomVolume random_volume(std::uint64_t seed, std::int64_t most);

/// Returns how many volumes a property test uses: WEIR_PROPERTY_VOLUMES if it is set, otherwise `ordinary`.
std::uint64_t property_volumes(std::uint64_t ordinary);

}  // namespace weir::test
