// Dense, signed, band-limited turbulence.
#pragma once

#include <memory>

#include "ingest/synthetic/field.h"

namespace weir {

/// `scale` times fractional Brownian motion of standard deviation 0.2. The octaves of spline noise have amplitudes
/// that grow with the cube root of the period, like velocity differences in Kolmogorov's inertial range. The finest
/// period is 4 voxels.
std::unique_ptr<SyntheticField> make_turbulence(const SyntheticOptions& options, float scale = 1.0F);

/// Integers around `base`: base + step * round(32 * turbulence), for values at the edge of float32. Exact if base and
/// step are multiples of the unit in the last place there.
std::unique_ptr<SyntheticField> make_stepped_turbulence(const SyntheticOptions& options, float base, float step);

/// Exactly `background` outside a ball of radius 0.4 of the extent. Inside, turbulence of both signs is added, faded
/// out towards the surface.
std::unique_ptr<SyntheticField> make_signed_ball(const SyntheticOptions& options, float background);

}  // namespace weir
