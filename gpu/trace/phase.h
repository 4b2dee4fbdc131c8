// The Henyey-Greenstein phase function (1941): how light turns at a collision.
#pragma once

#include "gpu/math/portable.h"
#include "gpu/math/vector3.h"

namespace weir {

/// Returns the probability per steradian that light turns by the angle whose cosine is `cosine`. `g` in (-1, 1) is
/// the mean cosine; forward is positive.
WEIR_HOST_DEVICE inline float phase(float cosine, float g) {
  const float d = 1.0F + g * g - 2.0F * g * cosine;
  return (1.0F - g * g) / (4.0F * kPi * d * std::sqrt(d));
}

/// Returns a unit direction distributed as phase(dot(forward, result), g), from two uniform numbers in [0, 1].
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
