// Free flight through a medium with macrocell majorants: delta tracking (Woodcock
// et al. 1965) finds a collision, ratio tracking (Novak et al. 2014) estimates a
// transmittance. Both are unbiased; every loop is bounded.
#pragma once

#include "gpu/math/random.h"
#include "gpu/trace/medium.h"

namespace weir {

/// Most tentative collisions of one flight. On average there are at most kMaxExtinction of them per shortest voxel
/// edge. The diagonal of 8192^3 cubes, 14189 edges, therefore takes 908,000, plus or minus a thousand. A flight that
/// needs more passes more than 16384 edges of clear cells that a wall touches; it counts as absorbed, so that it
/// ends. Not every flight would end by itself: from about 2^18 edges on, floats no longer distinguish such
/// collisions.
inline constexpr int kMaxTentative = 1 << 20;

/// The tentative collisions along a ray: where it would collide if the extinction were the majorant everywhere. If
/// majorants differ between cells, the optical depth that remains at a border carries over, because free flight is
/// memoryless.
class TentativeCollisions {
 public:
  /// Follows [0, length] of `ray`, which lies inside the volume. Draws one random number.
  WEIR_HOST_DEVICE TentativeCollisions(const CellLattice& cells, const Ray& ray, float length, Random& random)
      : walk_(cells, ray, 0.0F, length), depth_(free_depth(random.uniform())) {}

  /// Moves to the next tentative collision; returns false after the last. Call `redraw` before the next call if there
  /// was one.
  template <class Volume>
  WEIR_HOST_DEVICE bool next(const Medium<Volume>& medium, const Ray& ray) {
    for (;;) {
      const float left = majorant_ * (end_ - t_);
      if (depth_ < left) {
        ++count_;
        t_ += depth_ / majorant_;
        return true;
      }
      if (majorant_ > 0.0F) depth_ -= left;
      CellSpan span;
      if (!walk_.next(medium.cells, ray, span)) return false;
      majorant_ = medium.majorant(span.cell);
      t_ = span.t0;
      end_ = span.t1;
    }
  }
  WEIR_HOST_DEVICE void redraw(Random& random) { depth_ = free_depth(random.uniform()); }

  WEIR_HOST_DEVICE float t() const { return t_; }
  WEIR_HOST_DEVICE float majorant() const { return majorant_; }
  /// Returns whether there were more than kMaxTentative collisions.
  WEIR_HOST_DEVICE bool endless() const { return count_ > kMaxTentative; }

 private:
  CellWalk walk_;
  float depth_ = 0;
  float majorant_ = 0;
  float t_ = 0;
  float end_ = 0;
  int count_ = 0;
};

enum class FlightEnd { escaped, collided, absorbed };

struct Flight {
  FlightEnd end = FlightEnd::escaped;
  float t = 0;  ///< parameter of the collision
  Rgba colour;  ///< colour of the medium at the collision
};

/// Follows [0, length] of `ray`, which lies inside the volume, to its first collision.
template <class Volume>
WEIR_HOST_DEVICE Flight delta_track(const Medium<Volume>& medium, const Ray& ray, float length, RayKind kind,
                                    Random& random) {
  TentativeCollisions tentative(medium.cells, ray, length, random);
  while (tentative.next(medium, ray)) {
    if (tentative.endless()) return {FlightEnd::absorbed, tentative.t(), {}};
    const Rgba colour = medium.colour(ray.at(tentative.t()), kind, random);
    // Strictly less: a random number of 0 does not collide with vacuum.
    if (random.uniform() * tentative.majorant() < medium.extinction(colour.a)) {
      return {FlightEnd::collided, tentative.t(), colour};
    }
    tentative.redraw(random);
  }
  return {};
}

/// Returns an estimate in [0, 1] whose expectation is the transmittance along [0, length] of `ray`.
template <class Volume>
WEIR_HOST_DEVICE float ratio_track(const Medium<Volume>& medium, const Ray& ray, float length, RayKind kind,
                                   Random& random) {
  TentativeCollisions tentative(medium.cells, ray, length, random);
  float transmittance = 1.0F;
  while (tentative.next(medium, ray)) {
    if (tentative.endless()) return 0.0F;
    const Rgba colour = medium.colour(ray.at(tentative.t()), kind, random);
    transmittance *= greater(0.0F, 1.0F - medium.extinction(colour.a) / tentative.majorant());
    if (transmittance <= 0.0F) return 0.0F;
    if (transmittance < 0.1F) {  // Russian roulette: the rest hardly matters and may be long
      if (random.uniform() >= 0.5F) return 0.0F;
      transmittance *= 2.0F;
    }
    tentative.redraw(random);
  }
  return transmittance;
}

}  // namespace weir
