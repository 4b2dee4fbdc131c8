// The envelope of a cloud: a heap of ellipsoids, and the distance to the nearest of them.
#pragma once

#include <array>
#include <cstdint>

#include "ingest/synthetic/field.h"

namespace weir {

/// q(p) = sum over the axes of (slope * (p + 1/2) + shift)^2, p in voxels: 0 at the centre, 1 on the surface.
struct Ellipsoid {
  std::array<float, 3> slope{};
  std::array<float, 3> shift{};

  float distance(std::size_t axis, std::int64_t position) const {
    return slope[axis] * (static_cast<float>(position) + 0.5F) + shift[axis];
  }
  float term(std::size_t axis, std::int64_t position) const {
    const float d = distance(axis, position);
    return d * d;
  }
};

inline constexpr std::size_t kEllipsoids = 14;
using EllipsoidHeap = std::array<Ellipsoid, kEllipsoids>;

/// Returns a body in the middle with lobes around it, in proportion to the extent; y is up. Between 10 and 40 % of
/// the volume lie inside.
EllipsoidHeap make_heap(const SyntheticOptions& options);

/// The least q over a heap, for the rows of one tile. Ellipsoids that are nowhere the nearest in the tile are left
/// out.
class TileEllipsoids {
 public:
  TileEllipsoids(const EllipsoidHeap& heap, const Box& box);

  /// A lower bound of q in the tile.
  float least() const { return least_; }
  /// Returns a lower bound of q in the row.
  float least_in_row(std::int64_t y, std::int64_t z) const;
  /// Sets `q` for the row's voxels. Values beyond the end of the box are undefined.
  void row(std::int64_t y, std::int64_t z, std::array<float, kTileDim>& q) const;

 private:
  struct Near {
    Ellipsoid ellipsoid;
    float least_x_term = 0;
    std::array<float, kTileDim> x_terms{};
  };

  std::array<Near, kEllipsoids> near_;
  std::size_t count_ = 0;
  float least_ = 0;
};

}  // namespace weir
