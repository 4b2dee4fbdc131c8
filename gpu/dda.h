// The walk of a ray through macrocells: 3-D DDA (Amanatides and Woo 1987). Every
// step moves one cell coordinate one further in a fixed direction, so a walk
// ends after at most count.x + count.y + count.z steps, whatever the numbers.
#pragma once

#include "gpu/ray.h"

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

class CellWalk {
 public:
  /// Walks [t0, t1] of a ray that lies inside the domain there.
  WEIR_HOST_DEVICE CellWalk(const CellLattice& lattice, const Ray& ray, float t0, float t1)
      : edge_(lattice.edge), t_(t0), end_(t1), inside_(t0 < t1) {
    const Float3 start = ray.at(t0);
    const auto pitch = static_cast<std::int64_t>(lattice.count.x) * lattice.count.y;
    x_.set(lattice.count.x, 1, static_cast<float>(lattice.shift.x), ray.origin.x, ray.direction.x, start.x, edge_);
    y_.set(lattice.count.y, lattice.count.x, static_cast<float>(lattice.shift.y), ray.origin.y, ray.direction.y,
           start.y, edge_);
    z_.set(lattice.count.z, pitch, static_cast<float>(lattice.shift.z), ray.origin.z, ray.direction.z, start.z, edge_);
    index_ = x_.cell + y_.cell * y_.pitch + z_.cell * z_.pitch;
  }

  /// The next cell; false behind the last. Spans may be empty where a ray runs through an edge or corner.
  WEIR_HOST_DEVICE bool next(CellSpan& span) {
    if (!inside_) return false;
    const float exit = lesser(x_.exit, lesser(y_.exit, z_.exit));
    span.cell = index_;
    span.t0 = t_;
    span.t1 = clamped(exit, t_, end_);
    t_ = span.t1;
    inside_ = exit < end_;
    if (x_.exit <= exit) {
      step(x_);
    } else if (y_.exit <= exit) {
      step(y_);
    } else {
      step(z_);
    }
    return true;
  }

 private:
  struct Axis {
    std::int64_t pitch;  ///< of the cells' positions
    std::int32_t count;
    std::int32_t cell;
    std::int32_t step;
    float origin;
    float inverse;  ///< of the direction, finite
    float exit;     ///< parameter at which the ray leaves the cell

    WEIR_HOST_DEVICE void set(std::int32_t cells, std::int64_t cell_pitch, float shift, float from, float direction,
                              float start, float edge) {
      count = cells;
      pitch = cell_pitch;
      origin = from + shift;
      // A slower ray moves less than any position's precision along this axis; its inverse would overflow.
      const bool still = std::abs(direction) < 1e-30F;
      step = still ? 0 : (direction > 0.0F ? 1 : -1);
      inverse = still ? 0.0F : 1.0F / direction;
      const float at = clamped((start + shift) / edge, 0.0F, static_cast<float>(cells));
      cell = lesser(static_cast<std::int32_t>(at), cells - 1);
      set_exit(edge);
    }

    // Computed from the border itself, never accumulated.
    WEIR_HOST_DEVICE void set_exit(float edge) {
      const auto face = static_cast<float>(step > 0 ? cell + 1 : cell) * edge;
      exit = step == 0 ? kInfinity : (face - origin) * inverse;
    }
  };

  WEIR_HOST_DEVICE void step(Axis& axis) {
    axis.cell += axis.step;
    index_ += axis.step < 0 ? -axis.pitch : axis.pitch;
    inside_ = inside_ && axis.step != 0 && axis.cell >= 0 && axis.cell < axis.count;
    axis.set_exit(edge_);
  }

  Axis x_;
  Axis y_;
  Axis z_;
  std::int64_t index_;
  float edge_;
  float t_;
  float end_;
  bool inside_;
};

}  // namespace weir
