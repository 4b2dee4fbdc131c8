#include "tools/view/compared_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace weir {

std::optional<Scene> scene_of_other(const Scene& scene, const GridFrame& frame, const GridFrame& other) {
  if (!scene.volume.region) return scene;
  const auto corner = [&](const Index3& voxel) {
    Double3 place = frame.world(voxel);
    for (std::size_t axis = 0; axis < 3; ++axis) place[axis] -= 0.5 * frame.voxel_size[axis];
    return other.index(place);
  };
  const Double3 low = corner(scene.volume.region->lo);
  const Double3 high = corner(scene.volume.region->hi);
  Box region;
  constexpr std::array kAxes{&Index3::x, &Index3::y, &Index3::z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto of = kAxes[axis];
    // Clamped before the conversion to an integer, because places may lie anywhere.
    const auto near = [&](double at) {
      return std::clamp(at, static_cast<double>(other.domain.lo.*of - 1), static_cast<double>(other.domain.hi.*of + 1));
    };
    region.lo.*of = std::llround(near(low[axis]));
    region.hi.*of = std::llround(near(high[axis]));
    if (region.lo.*of == region.hi.*of) {
      region.lo.*of = static_cast<std::int64_t>(std::floor(near(0.5 * (low[axis] + high[axis]))));
      region.hi.*of = region.lo.*of + 1;
    }
  }
  region = intersect(region, other.domain);
  if (region.empty()) return std::nullopt;
  Scene mapped = scene;
  mapped.volume.region = region;
  return mapped;
}

Scene without_volume(Scene scene) {
  scene.volume.region.reset();
  scene.volume.opacity = {{0, 0}, {1, 0}};
  scene.volume.iso = std::numeric_limits<double>::infinity();
  return scene;
}

}  // namespace weir
