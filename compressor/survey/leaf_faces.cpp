#include "compressor/survey/leaf_faces.h"

#include <cmath>

#include "format/leaf/bounds.h"

namespace weir {
namespace {

struct Stretch {
  std::int64_t first;
  std::int64_t end;
};

// Returns the positions along an axis of length `extent` that a neighbour on side `side` (-1, 0 or 1) touches.
Stretch touched(std::int64_t side, std::int64_t extent) { return {side > 0 ? extent - 1 : 0, side < 0 ? 1 : extent}; }

}  // namespace

LeafFaces faces_of(std::span<const float> values, const Index3& extent) {
  LeafFaces faces;
  faces.bounds.fill(kNoBounds);
  for_each_index({{-1, -1, -1}, {2, 2, 2}}, [&](const Index3& toward) {
    if (toward == Index3{}) return;
    const Stretch x = touched(toward.x, extent.x);
    const Stretch y = touched(toward.y, extent.y);
    const Stretch z = touched(toward.z, extent.z);
    MinMax& bounds = faces.bounds[LeafFaces::direction(toward)];
    for_each_index({{x.first, y.first, z.first}, {x.end, y.end, z.end}}, [&](const Index3& i) {
      const float v = values[static_cast<std::size_t>(linear_index(i, extent))];
      if (std::isfinite(v)) widen(bounds, {v, v});
    });
  });
  return faces;
}

}  // namespace weir
