// Analytic volumes: each value follows from a simple formula.
#pragma once

#include <memory>

#include "ingest/synthetic/field.h"

namespace weir {

/// `value` everywhere. Any bit pattern is allowed, including NaN and -0.
std::unique_ptr<SyntheticField> make_constant(float value);

/// lo at the first voxel, hi at the last, linear in x + y + z (one voxel: lo). Computed in double.
std::unique_ptr<SyntheticField> make_gradient(const SyntheticOptions& options, double lo, double hi);

/// Four concentric shells around the centre, 0 between them. Let r be the distance from the centre in units of half
/// the shortest axis. Shell k = 1..4 has radius k/5, half thickness 1/20 and value k/4 * (1 - t^2), t = (r - k/5) *
/// 20.
std::unique_ptr<SyntheticField> make_shells(const SyntheticOptions& options);

}  // namespace weir
