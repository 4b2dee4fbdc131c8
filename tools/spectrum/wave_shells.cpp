#include "tools/spectrum/wave_shells.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/spectrum/block_transform.h"

namespace weir {
namespace {

/// Returns the cycles per world unit of position `m` along an axis of `n` voxels: 0, 1/L, ...; negative beyond the
/// middle.
double cycles(std::int64_t m, std::int64_t n, double spacing) {
  return static_cast<double>(m <= n / 2 ? m : m - n) / (static_cast<double>(n) * spacing);
}

/// Returns the step between two shells: the step of the longest axis, unless that gives too many shells.
double step_of(const std::array<std::int64_t, 3>& n, const std::array<double, 3>& spacing) {
  double step = std::numeric_limits<double>::infinity();
  std::array<double, 3> highest{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (n[axis] == 1) continue;
    step = std::min(step, cycles(1, n[axis], spacing[axis]));
    highest[axis] = cycles(n[axis] / 2, n[axis], spacing[axis]);
  }
  return std::max(step, std::hypot(highest[0], highest[1], highest[2]) / WaveShells::kMostShells);
}

}  // namespace

WaveShells::WaveShells(const Index3& extent, const std::array<double, 3>& spacing) {
  const std::array<std::int64_t, 3> n{extent.x, extent.y, extent.z};
  step_ = step_of(n, spacing);
  const Index3 all = BlockTransform::frequencies(extent);
  places_.reserve(static_cast<std::size_t>(volume(all)));
  for_each_index({{}, all}, [&](const Index3& m) {
    Place place;
    double length = 0;
    if (m != Index3{}) {
      length = std::hypot(cycles(m.x, n[0], spacing[0]), cycles(m.y, n[1], spacing[1]), cycles(m.z, n[2], spacing[2]));
      place.shell = static_cast<std::uint16_t>(std::max(std::lround(length / step_), 1L));
      place.weight = m.x == 0 || 2 * m.x == n[0] ? 1 : 2;
    }
    if (place.shell >= modes_.size()) {
      modes_.resize(place.shell + std::size_t{1});
      lowest_.resize(modes_.size(), std::numeric_limits<double>::infinity());
    }
    modes_[place.shell] += place.weight;
    lowest_[place.shell] = std::min(lowest_[place.shell], length);
    places_.push_back(place);
  });
}

}  // namespace weir
