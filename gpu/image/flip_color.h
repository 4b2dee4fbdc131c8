// The colour spaces of FLIP, all relative to the white of sRGB (D65), and the distance between two colours in them.
#pragma once

#include "gpu/math/vector3.h"

namespace weir {

/// Returns YCxCz of linear sRGB: x is Y, luminance from -16 to 100; y is Cx, red against green; z is Cz, blue against
/// yellow. The map is linear in the colour, so that the result can be filtered.
Float3 opponent_from_linear(const Float3& rgb);
/// The inverse. After a filter the result may lie outside [0, 1].
Float3 linear_from_opponent(const Float3& opponent);

/// Returns CIELAB of linear sRGB with a* and b* scaled by L* / 100: dark colours differ less (Hunt 1952).
Float3 hunt_lab(const Float3& rgb);

/// Returns |dL| + the Euclidean distance of (a, b) of two colours of hunt_lab, to the power of 0.7 (Abasi, Tehran and
/// Fairchild 2020).
float hyab_difference(const Float3& a, const Float3& b);

/// Maps a difference of hyab_difference to [0, 1]. The first 0.4 of the largest difference, that between green and
/// blue, takes [0, 0.95]; larger differences are nearly as bad (Andersson et al. 2020, section 4.1.3).
float redistributed(float difference);

}  // namespace weir
