// Dense, signed, band-limited turbulence.
#pragma once

#include <memory>

#include "ingest/synthetic/field.h"

namespace weir {

/// `scale` times fractional Brownian motion of standard deviation 0.2: octaves of spline noise whose
/// amplitude grows with the cube root of the period (velocity differences in Kolmogorov's inertial
/// range), finest period 4 voxels.
std::unique_ptr<SyntheticField> make_turbulence(const SyntheticOptions& options, float scale = 1.0F);

/// Integers around `base`: base + step * round(32 * turbulence), for values at the edge of float32.
/// Exact where base and step are multiples of the unit in the last place there.
std::unique_ptr<SyntheticField> make_stepped_turbulence(const SyntheticOptions& options, float base, float step);

/// Exactly `background` outside a ball of radius 0.4 of the extent; inside, turbulence of both signs
/// on top of it, faded out towards the surface.
std::unique_ptr<SyntheticField> make_signed_ball(const SyntheticOptions& options, float background);

}  // namespace weir
