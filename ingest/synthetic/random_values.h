// Volumes whose voxels are independent of their neighbours.
#pragma once

#include <memory>

#include "ingest/synthetic/field.h"

namespace weir {

/// White noise, uniform over the multiples of 2^-24 in [0, 1).
std::unique_ptr<SyntheticField> make_white_noise(const SyntheticOptions& options);

/// +0 and -0, each with probability one half. They compare equal but differ in their bits.
std::unique_ptr<SyntheticField> make_signed_zeros(const SyntheticOptions& options);

/// k * 2^-149 with k uniform in 1..4096: every value denormal.
std::unique_ptr<SyntheticField> make_denormals(const SyntheticOptions& options);

/// 2^24 + 2 k with k uniform in 0..2^20 - 1: float32 holds these integers, but not the odd integers between them.
std::unique_ptr<SyntheticField> make_big_integers(const SyntheticOptions& options);

}  // namespace weir
