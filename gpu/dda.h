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
    set(0, lattice.count.x, lattice.shift.x, ray.origin.x, ray.direction.x, start.x);
    set(1, lattice.count.y, lattice.shift.y, ray.origin.y, ray.direction.y, start.y);
    set(2, lattice.count.z, lattice.shift.z, ray.origin.z, ray.direction.z, start.z);
  }

  /// The next cell; false behind the last. Spans may be empty where a ray runs through an edge or corner.
  WEIR_HOST_DEVICE bool next(CellSpan& span) {
    if (!inside_) return false;
    const int axis = exit_[0] <= exit_[1] ? (exit_[0] <= exit_[2] ? 0 : 2) : (exit_[1] <= exit_[2] ? 1 : 2);
    span.cell = cell_[0] + count_[0] * (cell_[1] + static_cast<std::int64_t>(count_[1]) * cell_[2]);
    span.t0 = t_;
    span.t1 = clamped(exit_[axis], t_, end_);
    t_ = span.t1;
    cell_[axis] += step_[axis];
    inside_ = exit_[axis] < end_ && cell_[axis] >= 0 && cell_[axis] < count_[axis];
    exit_[axis] = border(axis);
    return true;
  }

 private:
  WEIR_HOST_DEVICE void set(int axis, std::int32_t count, std::int32_t shift, float origin, float direction,
                            float start) {
    const auto offset = static_cast<float>(shift);
    count_[axis] = count;
    origin_[axis] = origin + offset;
    direction_[axis] = direction;
    step_[axis] = direction > 0.0F ? 1 : (direction < 0.0F ? -1 : 0);
    const float at = clamped((start + offset) / edge_, 0.0F, static_cast<float>(count));
    cell_[axis] = lesser(static_cast<std::int32_t>(at), count - 1);
    exit_[axis] = border(axis);
  }

  // Parameter at which the ray leaves the current cell along `axis`. Computed from the border itself,
  // never accumulated; divided, since the inverse of a denormal direction is infinite and 0 * inf NaN.
  WEIR_HOST_DEVICE float border(int axis) const {
    if (step_[axis] == 0) return kInfinity;
    const auto face = static_cast<float>(cell_[axis] + (step_[axis] > 0 ? 1 : 0)) * edge_;
    return (face - origin_[axis]) / direction_[axis];
  }

  float edge_;
  float t_;
  float end_;
  bool inside_;
  std::int32_t count_[3] = {};
  std::int32_t cell_[3] = {};
  std::int32_t step_[3] = {};
  float origin_[3] = {};
  float direction_[3] = {};
  float exit_[3] = {};
};

}  // namespace weir
