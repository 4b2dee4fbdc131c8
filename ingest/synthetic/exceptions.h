// Volumes where few voxels, or each other one, differ from the rest.
#pragma once

#include <memory>

#include "ingest/synthetic/field.h"

namespace weir {

/// The gradient 0..1 with, by linear index i: NaN where i mod 97 = 13, +Inf where it is 41, -Inf where it is 77.
std::unique_ptr<SyntheticField> make_some_nonfinite(const SyntheticOptions& options);

/// 1 at one voxel chosen by the seed, +0 elsewhere.
std::unique_ptr<SyntheticField> make_hot_voxel(const SyntheticOptions& options);

/// 1 everywhere but +10^6 at linear index floor(n/3) and -10^6 at floor(2n/3) of n voxels (one voxel: +10^6).
std::unique_ptr<SyntheticField> make_plateau(const SyntheticOptions& options);

/// 0 where x + y + z is even, 1 where it is odd.
std::unique_ptr<SyntheticField> make_checkerboard();

/// By linear index i of n voxels: 1/8, 3/8, 5/8, 7/8 where i mod 4 = 0, 1, 2, 3 - exactly as often each - and
/// 0 at the last n mod 4.
std::unique_ptr<SyntheticField> make_ties(const SyntheticOptions& options);

/// 1 in every 8^3 leaf but for one of its in-domain voxels, chosen by the seed, which is 2.
std::unique_ptr<SyntheticField> make_nearly_constant(const SyntheticOptions& options);

}  // namespace weir
