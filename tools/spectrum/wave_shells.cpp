#include "tools/spectrum/wave_shells.h"

#include <algorithm>
#include <cmath>

#include "tools/spectrum/block_transform.h"

namespace weir {
namespace {

/// Cycles per world unit of position `m` along an axis of `n` voxels: 0, 1/L, ... and from the middle on below 0.
double cycles(std::int64_t m, std::int64_t n, double spacing) {
  return static_cast<double>(m <= n / 2 ? m : m - n) / (static_cast<double>(n) * spacing);
}

}  // namespace

WaveShells::WaveShells(const Index3& extent, const std::array<double, 3>& spacing) {
  const std::array<std::int64_t, 3> n{extent.x, extent.y, extent.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (n[axis] > 1) step_ = std::max(step_, cycles(1, n[axis], spacing[axis]));
  }
  const Index3 all = BlockTransform::frequencies(extent);
  places_.reserve(static_cast<std::size_t>(volume(all)));
  for_each_index({{}, all}, [&](const Index3& m) {
    Place place;
    if (m != Index3{}) {
      const double length =
          std::hypot(cycles(m.x, n[0], spacing[0]), cycles(m.y, n[1], spacing[1]), cycles(m.z, n[2], spacing[2]));
      place.shell = static_cast<std::uint16_t>(std::max(std::lround(length / step_), 1L));
      place.weight = m.x == 0 || 2 * m.x == n[0] ? 1 : 2;
    }
    if (place.shell >= modes_.size()) modes_.resize(place.shell + std::size_t{1});
    modes_[place.shell] += place.weight;
    places_.push_back(place);
  });
}

}  // namespace weir
