// Free flight through a medium with macrocell majorants: delta tracking (Woodcock
// et al. 1965) finds a collision, ratio tracking (Novak et al. 2014) estimates a
// transmittance. Both are unbiased; every loop is bounded.
#pragma once

#include "gpu/math/random.h"
#include "gpu/trace/medium.h"

namespace weir {

/// Tentative collisions of one flight. There are kMaxExtinction of them to a shortest voxel edge at most, in the mean,
/// so that the diagonal of 8192^3 cubes, 14189 edges, takes 908,000, give or take a thousand. A flight that needs more
/// leads through more than 16384 edges of clear cells that a wall touches: it counts as absorbed, so that it ends. Not
/// all would end by themselves: from some 2^18 edges on, floats tell such collisions no longer apart.
inline constexpr int kMaxTentative = 1 << 20;

/// The tentative collisions along a ray: where it would collide if the extinction were the majorant everywhere. Where
/// majorants are given by cells, the optical depth that remains at a border carries over, since it is memoryless.
class TentativeCollisions {
 public:
  /// Along [0, length] of `ray`, which lies inside the volume. Draws one number.
  WEIR_HOST_DEVICE TentativeCollisions(const CellLattice& cells, const Ray& ray, float length, Random& random)
      : walk_(cells, ray, 0.0F, length), depth_(free_depth(random.uniform())) {}

  /// Moves on to the next one; false behind the last. `redraw` first where there was one.
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
  /// Whether there were more than kMaxTentative.
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
  float t = 0;  ///< of the collision
  Rgba colour;  ///< of the medium there
};

/// Flies along [0, length] of `ray`, which lies inside the volume.
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

/// An estimate in [0, 1] whose expectation is the transmittance along [0, length] of `ray`.
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
