// The Henyey-Greenstein phase function (1941): how light turns at a collision.
#pragma once

#include "gpu/math/portable.h"
#include "gpu/math/vector3.h"

namespace weir {

/// Probability per steradian that light is turned by the angle of cosine `cosine`; `g` in (-1, 1) is
/// the mean cosine, positive forward.
WEIR_HOST_DEVICE inline float phase(float cosine, float g) {
  const float d = 1.0F + g * g - 2.0F * g * cosine;
  return (1.0F - g * g) / (4.0F * kPi * d * std::sqrt(d));
}

/// A unit direction distributed as phase(dot(forward, result), g), from two uniform numbers in [0, 1].
WEIR_HOST_DEVICE inline Float3 sample_phase(const Float3& forward, float g, float u1, float u2) {
  float cosine = 1.0F - 2.0F * u1;
  if (std::abs(g) > 1e-3F) {  // below, the general formula cancels and the phase is flat within 1e-3
    const float s = (1.0F - g * g) / (1.0F - g + 2.0F * g * u1);
    cosine = (1.0F + g * g - s * s) / (2.0F * g);
  }
  cosine = clamped(cosine, -1.0F, 1.0F);
  const float sine = std::sqrt(1.0F - cosine * cosine);
  const float angle = 2.0F * kPi * u2;
  Float3 u;
  Float3 v;
  frame(forward, u, v);
  return normalised(u * (sine * std::cos(angle)) + v * (sine * std::sin(angle)) + forward * cosine, forward);
}

}  // namespace weir
