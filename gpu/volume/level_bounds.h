// Bounds of the values that look-ups of levels of detail find in the cells of a macrocell grid. For host and device.
#pragma once

#include <cmath>
#include <cstdint>

#include "format/nanovdb/macrocells.h"
#include "gpu/math/box_points.h"
#include "gpu/math/dda.h"
#include "gpu/volume/level_choice.h"
#include "gpu/volume/level_lattice.h"

namespace weir {

/// Calculates, by one group of threads per cell, the bounds of the finite values that rays of every kind may read in
/// it, from voxels and from levels. `Texels` has voxel(i), which returns texel `i` of a level, counted from its
/// first.
template <class Texels>
struct LevelBounds {
  struct Shared {
    MinMax of_warps[32];
  };

  LevelLattice lattice;
  int first = 1;  ///< the finest level
  int count = 0;  ///< number of levels
  Texels texels[kMostLevels];
  LevelChoice choice;
  bool drafts = false;  ///< look-ups of missing voxels read the finest level
  CellLattice cells;
  const MinMax* voxels = nullptr;  ///< bounds of each cell's voxels and of those that filtered look-ups in it reach
  MinMax* bounds = nullptr;        ///< the result

  template <class Thread>
  WEIR_HOST_DEVICE void operator()(const Thread& thread, Shared& shared, std::uint32_t cell) const {
    const Reach reach = reach_of(cell);
    MinMax seen{kInfinity, -kInfinity};
    for (int i = reach.finest; i <= reach.coarsest; ++i) include(thread, reach, i, seen);
    seen = thread.widest(seen, shared.of_warps);
    if (thread.index() != 0) return;
    if (reach.voxels) {
      // NaN bounds are unknown and stay so.
      const MinMax& own = voxels[cell];
      seen = {seen.min < own.min ? seen.min : own.min, seen.max > own.max ? seen.max : own.max};
    }
    bounds[cell] = seen;
  }

 private:
  // What look-ups in a cell can reach.
  struct Reach {
    RayBox box;  // voxels, inside the domain, with a margin for rounding
    bool voxels;
    int finest;    // counted from the first level
    int coarsest;  // less than `finest`: no levels
  };

  WEIR_HOST_DEVICE Reach reach_of(std::uint32_t cell) const {
    constexpr float kRounding = 0.0625F;  // voxels
    const auto nx = static_cast<std::uint32_t>(cells.count.x);
    const auto ny = static_cast<std::uint32_t>(cells.count.y);
    const Float3 i{static_cast<float>(cell % nx), static_cast<float>(cell / nx % ny),
                   static_cast<float>(cell / nx / ny)};
    const auto inside = [&](float p, std::int32_t extent) { return clamped(p, 0.0F, static_cast<float>(extent)); };
    const auto begin = [&](float at, std::int32_t shift, std::int32_t extent) {
      return inside(at * cells.edge - static_cast<float>(shift) - kRounding, extent);
    };
    const auto end = [&](float at, std::int32_t shift, std::int32_t extent) {
      return inside((at + 1.0F) * cells.edge - static_cast<float>(shift) + kRounding, extent);
    };
    const Int3& shift = cells.shift;
    const Int3& extent = lattice.extent;
    const RayBox box{{begin(i.x, shift.x, extent.x), begin(i.y, shift.y, extent.y), begin(i.z, shift.z, extent.z)},
                     {end(i.x, shift.x, extent.x), end(i.y, shift.y, extent.y), end(i.z, shift.z, extent.z)}};

    constexpr float kLogarithm = 0.01F;  // levels; more than the logarithms of two machines differ
    const Float3 near = nearest_point(box, choice.eye);
    const Float3 far = farthest_point(box, choice.eye);
    const float fine = lesser(choice.level(near, RayKind::camera), choice.level(near, RayKind::scattered)) - kLogarithm;
    const float coarse =
        greater(choice.level(far, RayKind::camera), choice.level(far, RayKind::scattered)) + kLogarithm;
    const auto last = static_cast<float>(count - 1);
    const auto from = static_cast<float>(first);
    const auto finest = static_cast<int>(std::floor(clamped(fine - from, 0.0F, last)));
    // Look-ups begin to mix the first level in at one level below it.
    if (!drafts && coarse <= from - 1.0F) return {box, true, finest, finest - 1};
    return {box, fine < from, finest, static_cast<int>(std::ceil(clamped(coarse - from, 0.0F, last)))};
  }

  // A look-up blends the two nearest texels along each axis.
  template <class Thread>
  WEIR_HOST_DEVICE void include(const Thread& thread, const Reach& reach, int i, MinMax& seen) const {
    const int level = first + i;
    const Int3 n = lattice.texels(level);
    const Float3 from = lattice.position(reach.box.low, level);
    const Float3 to = lattice.position(reach.box.high, level);
    const auto below = [](float at, std::int32_t size) {
      return clamped(static_cast<std::int32_t>(std::floor(at - 0.5F)), 0, size - 1);
    };
    const auto above = [](float at, std::int32_t size) {
      return clamped(static_cast<std::int32_t>(std::floor(at - 0.5F)) + 1, 0, size - 1);
    };
    const Int3 low{below(from.x, n.x), below(from.y, n.y), below(from.z, n.z)};
    const Int3 high{above(to.x, n.x), above(to.y, n.y), above(to.z, n.z)};
    const std::int64_t sy = high.y - low.y + 1;
    const std::int64_t rows = sy * (high.z - low.z + 1);
    for (std::int64_t row = thread.index(); row < rows; row += thread.count()) {
      const auto y = low.y + static_cast<std::int32_t>(row % sy);
      const auto z = low.z + static_cast<std::int32_t>(row / sy);
      for (std::int32_t x = low.x; x <= high.x; ++x) {
        const float value = texels[i].voxel({x, y, z});
        if (!is_finite(value)) continue;  // a value filtered with it is not finite either, and shows nothing
        seen = {lesser(seen.min, value), greater(seen.max, value)};
      }
    }
  }
};

}  // namespace weir
