// The walk of a ray through macrocells: 3-D DDA (Amanatides and Woo 1987). Every
// step moves one cell coordinate one further in a fixed direction, so a walk
// ends after at most count.x + count.y + count.z steps, whatever the numbers.
#pragma once

#include "gpu/math/ray.h"

namespace weir {

/// The cells over a domain whose lowest corner is the local origin.
struct CellLattice {
  Int3 count;      ///< cells along each axis, at least 1
  Int3 shift;      ///< voxels from the first cell's corner to the domain's, in [0, edge)
  float edge = 1;  ///< voxels

  WEIR_HOST_DEVICE std::int64_t size() const { return static_cast<std::int64_t>(count.x) * count.y * count.z; }
};

/// A stretch of a ray inside one cell; t0 <= t1.
struct CellSpan {
  std::int64_t cell = 0;  ///< x fastest
  float t0 = 0;
  float t1 = 0;
};

/// The position of a walk. The lattice and the ray, which do not change, are passed again at each step, so that a
/// thread's registers hold no second copy of them.
class CellWalk {
 public:
  /// Walks [t0, t1] of a ray. The ray lies inside the domain there.
  WEIR_HOST_DEVICE CellWalk(const CellLattice& lattice, const Ray& ray, float t0, float t1)
      : t_(t0), end_(t1), inside_(t0 < t1) {
    const Float3 start = ray.at(t0);
    x_.set(lattice.count.x, lattice.shift.x, ray.origin.x, ray.direction.x, start.x, lattice.edge);
    y_.set(lattice.count.y, lattice.shift.y, ray.origin.y, ray.direction.y, start.y, lattice.edge);
    z_.set(lattice.count.z, lattice.shift.z, ray.origin.z, ray.direction.z, start.z, lattice.edge);
  }

  /// Moves to the next cell; returns false after the last. A span may be empty if the ray passes through an edge or
  /// corner. `lattice` and `ray` are those of the constructor.
  WEIR_HOST_DEVICE bool next(const CellLattice& lattice, const Ray& ray, CellSpan& span) {
    if (!inside_) return false;
    const float exit = lesser(x_.exit, lesser(y_.exit, z_.exit));
    span.cell = table_index({x_.cell, y_.cell, z_.cell}, lattice.count);
    span.t0 = t_;
    span.t1 = clamped(exit, t_, end_);
    t_ = span.t1;
    inside_ = exit < end_;
    if (x_.exit <= exit) {
      inside_ = x_.advance(lattice.count.x, lattice.shift.x, ray.origin.x, lattice.edge) && inside_;
    } else if (y_.exit <= exit) {
      inside_ = y_.advance(lattice.count.y, lattice.shift.y, ray.origin.y, lattice.edge) && inside_;
    } else {
      inside_ = z_.advance(lattice.count.z, lattice.shift.z, ray.origin.z, lattice.edge) && inside_;
    }
    return true;
  }

 private:
  struct Axis {
    std::int32_t cell;
    float inverse;  ///< inverse of the direction, finite; 0: the ray does not move along this axis
    float exit;     ///< parameter at which the ray leaves the cell

    WEIR_HOST_DEVICE void set(std::int32_t cells, std::int32_t shift, float origin, float direction, float start,
                              float edge) {
      // A smaller component moves less than a position's precision along this axis, and its inverse would overflow.
      inverse = std::abs(direction) < 1e-30F ? 0.0F : 1.0F / direction;
      const float at = clamped((start + static_cast<float>(shift)) / edge, 0.0F, static_cast<float>(cells));
      cell = lesser(static_cast<std::int32_t>(at), cells - 1);
      set_exit(shift, origin, edge);
    }

    // Computed from the border itself and never accumulated, so that errors do not grow.
    WEIR_HOST_DEVICE void set_exit(std::int32_t shift, float origin, float edge) {
      const auto face = static_cast<float>(inverse > 0.0F ? cell + 1 : cell) * edge;
      exit = inverse == 0.0F ? kInfinity : (face - (origin + static_cast<float>(shift))) * inverse;
    }

    // Returns false if there is no further cell.
    WEIR_HOST_DEVICE bool advance(std::int32_t cells, std::int32_t shift, float origin, float edge) {
      if (inverse == 0.0F) return false;
      cell += inverse > 0.0F ? 1 : -1;
      set_exit(shift, origin, edge);
      return cell >= 0 && cell < cells;
    }
  };

  Axis x_;
  Axis y_;
  Axis z_;
  float t_;
  float end_;
  bool inside_;
};

}  // namespace weir
