// Free flight through a medium with macrocell majorants: delta tracking (Woodcock
// et al. 1965) finds a collision, ratio tracking (Novak et al. 2014) estimates a
// transmittance. Both are unbiased; every loop is bounded.
#pragma once

#include "gpu/medium.h"
#include "gpu/random.h"

namespace weir {

/// Tentative collisions of one flight. A flight that needs more runs where the majorant is far above
/// the extinction over thousands of mean free paths: it counts as absorbed.
inline constexpr int kMaxTentative = 1 << 16;

enum class FlightEnd { escaped, collided, absorbed };

struct Flight {
  FlightEnd end = FlightEnd::escaped;
  float t = 0;  ///< of the collision
  Rgba colour;  ///< of the medium there
};

/// Flies along [0, length] of `ray`, which lies inside the volume. Where majorants are given
/// by cells, the optical depth that remains at a border carries over, since it is memoryless.
template <class Volume>
WEIR_HOST_DEVICE Flight delta_track(const Medium<Volume>& medium, const Ray& ray, float length, Random& random) {
  CellWalk walk(medium.cells, ray, 0.0F, length);
  CellSpan span;
  float depth = free_depth(random.uniform());
  int tentative = 0;
  while (walk.next(span)) {
    const float majorant = medium.majorant(span.cell);
    if (!(majorant > 0.0F)) continue;
    float t = span.t0;
    for (;;) {
      const float left = majorant * (span.t1 - t);
      if (!(depth < left)) {
        depth -= left;
        break;
      }
      if (++tentative > kMaxTentative) return {FlightEnd::absorbed, t, {}};
      t += depth / majorant;
      const Rgba colour = medium.transfer.at(medium.volume.sample(ray.at(t), random));
      // Strictly less: a random number of 0 does not collide with vacuum.
      if (random.uniform() * majorant < medium.extinction(colour.a)) return {FlightEnd::collided, t, colour};
      depth = free_depth(random.uniform());
    }
  }
  return {};
}

/// An estimate in [0, 1] whose expectation is the transmittance along [0, length] of `ray`.
template <class Volume>
WEIR_HOST_DEVICE float ratio_track(const Medium<Volume>& medium, const Ray& ray, float length, Random& random) {
  CellWalk walk(medium.cells, ray, 0.0F, length);
  CellSpan span;
  float depth = free_depth(random.uniform());
  float transmittance = 1.0F;
  int tentative = 0;
  while (walk.next(span)) {
    const float majorant = medium.majorant(span.cell);
    if (!(majorant > 0.0F)) continue;
    float t = span.t0;
    for (;;) {
      const float left = majorant * (span.t1 - t);
      if (!(depth < left)) {
        depth -= left;
        break;
      }
      if (++tentative > kMaxTentative) return 0.0F;
      t += depth / majorant;
      const Rgba colour = medium.transfer.at(medium.volume.sample(ray.at(t), random));
      transmittance *= greater(0.0F, 1.0F - medium.extinction(colour.a) / majorant);
      if (transmittance <= 0.0F) return 0.0F;
      if (transmittance < 0.1F) {  // Russian roulette: the rest hardly matters and may be long
        if (random.uniform() >= 0.5F) return 0.0F;
        transmittance *= 2.0F;
      }
      depth = free_depth(random.uniform());
    }
  }
  return transmittance;
}

}  // namespace weir
