#include "ingest/values/axis_placement.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "format/base/text.h"

namespace weir {
namespace {

/// Parts of a step below this fraction of its largest part are rounding of the float32 matrices and quaternions in
/// headers.
constexpr double kAxisRounding = 1e-6;

/// Returns the world axis that a step runs along. Returns nullopt for an oblique step and for a zero step.
std::optional<std::size_t> world_axis(const Vector3& step) {
  const double largest = std::max({std::fabs(step[0]), std::fabs(step[1]), std::fabs(step[2])});
  std::optional<std::size_t> axis;
  for (std::size_t c = 0; c < 3; ++c) {
    if (std::fabs(step[c]) <= kAxisRounding * largest) continue;
    if (axis) return std::nullopt;
    axis = c;
  }
  return axis;
}

double length(const Vector3& step) { return std::sqrt(step[0] * step[0] + step[1] * step[1] + step[2] * step[2]); }

}  // namespace

AxisPlacement place_axes(std::span<const Vector3> steps, const Vector3& zero, const Index3& first) {
  AxisPlacement placement;
  placement.origin = zero;
  std::array<std::optional<std::size_t>, 3> along;
  std::array<bool, 3> taken{};
  bool oblique = false;
  for (std::size_t a = 0; a < steps.size(); ++a) {
    along[a] = world_axis(steps[a]);
    placement.spacing[a] = along[a] ? std::fabs(steps[a][*along[a]]) : length(steps[a]);
    oblique = oblique || !along[a] || taken[*along[a]];
    if (along[a]) taken[*along[a]] = true;
  }
  if (oblique) {
    placement.orientation = "axes oblique to the file's world, ignored: spacing is the length of a step";
    return placement;
  }
  const std::array<std::int64_t, 3> indices{first.x, first.y, first.z};
  std::string axes;
  for (std::size_t a = 0; a < 3; ++a) {
    // An axis without a step takes a free world axis, its own if possible.
    for (std::size_t c = 0; !along[a]; ++c) {
      const std::size_t candidate = (a + c) % 3;
      if (taken[candidate]) continue;
      along[a] = candidate;
      taken[candidate] = true;
    }
    placement.origin[a] = zero[*along[a]];
    const bool against = a < steps.size() && steps[a][*along[a]] < 0;
    // An axis that runs against its world axis has spacing = -step. At the first voxel, zero + index * step = origin
    // + index * spacing.
    if (against && indices[a] != 0) placement.origin[a] -= 2 * static_cast<double>(indices[a]) * placement.spacing[a];
    axes += (axes.empty() ? "" : ", ");
    axes += against ? '-' : '+';
    axes += "xyz"[*along[a]];
  }
  if (axes != "+x, +y, +z") {
    placement.orientation = "axes along " + axes + " of the file's world; voxels keep the file's order";
  }
  return placement;
}

std::string vector_text(const Vector3& v) { return cat(v[0], ',', v[1], ',', v[2]); }

}  // namespace weir
