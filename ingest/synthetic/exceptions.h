// Volumes in which few voxels, or every other one, differ from the rest.
#pragma once

#include <memory>

#include "ingest/synthetic/field.h"

namespace weir {

/// The gradient 0..1, except by linear index i: NaN if i mod 97 = 13, +Inf if it is 41, -Inf if it is 77.
std::unique_ptr<SyntheticField> make_some_nonfinite(const SyntheticOptions& options);

/// 1 at one voxel chosen by the seed, +0 elsewhere.
std::unique_ptr<SyntheticField> make_hot_voxel(const SyntheticOptions& options);

/// 1 everywhere, except +10^6 at linear index floor(n/3) and -10^6 at floor(2n/3) of n voxels (one voxel: +10^6).
std::unique_ptr<SyntheticField> make_plateau(const SyntheticOptions& options);

/// 0 if x + y + z is even, 1 if it is odd.
std::unique_ptr<SyntheticField> make_checkerboard();

/// By linear index i of n voxels: 1/8, 3/8, 5/8, 7/8 if i mod 4 = 0, 1, 2, 3, each equally often, and 0 at the last n
/// mod 4 voxels.
std::unique_ptr<SyntheticField> make_ties(const SyntheticOptions& options);

/// 1 everywhere, except that one voxel of every 8^3 leaf is 2. The seed chooses the voxel, which is inside the
/// domain.
std::unique_ptr<SyntheticField> make_nearly_constant(const SyntheticOptions& options);

}  // namespace weir
