#include "ingest/vdb/grid_placement.h"

#include <algorithm>
#include <cmath>

#include "format/base/text.h"

namespace weir {
namespace {

bool finite(const Vector3& v) {
  return std::all_of(v.begin(), v.end(), [](double c) { return std::isfinite(c); });
}

}  // namespace

bool placeable(const std::array<Vector3, 3>& steps, const Vector3& first) {
  return finite(first) && std::all_of(steps.begin(), steps.end(), [](const Vector3& step) {
           const double square = step[0] * step[0] + step[1] * step[1] + step[2] * step[2];
           return std::isfinite(square) && square > 0;
         });
}

AxisPlacement place_grid(const std::array<Vector3, 3>& steps, const Vector3& zero, const Box& active) {
  return place_axes(steps, zero, active.empty() ? Index3{} : active.lo);
}

void describe_box(const Box& active, DatasetInfo& info) {
  if (active.empty()) {
    info.obstacle = "it has no active voxel";
    return;
  }
  const Index3 extent = active.extent();
  info.extents = {extent.x, extent.y, extent.z};
  info.attributes.emplace_back("index origin", cat(active.lo.x, ',', active.lo.y, ',', active.lo.z));
}

void describe_placement(const AxisPlacement& placement, DatasetInfo& info) {
  info.attributes.emplace_back("spacing", vector_text(placement.spacing));
  info.attributes.emplace_back("origin", vector_text(placement.origin));
  if (!placement.orientation.empty()) info.attributes.emplace_back("orientation", placement.orientation);
}

}  // namespace weir
