#include "ingest/synthetic/slabs.h"

#include <algorithm>

namespace weir {
namespace {

std::int64_t round_count(std::int64_t fitting, std::int64_t left) {
  for (const std::int64_t step : {32, 8}) {
    if (fitting >= step) fitting = fitting / step * step;
  }
  return std::min(fitting, left);
}

}  // namespace

Box slab_at(const Index3& extent, std::int64_t first, std::int64_t most_voxels) {
  const Index3 lo = index_at(first, extent);
  const std::int64_t plane = extent.x * extent.y;
  if (lo.x == 0 && lo.y == 0 && most_voxels >= plane) {
    return {lo, {extent.x, extent.y, lo.z + round_count(most_voxels / plane, extent.z - lo.z)}};
  }
  if (lo.x == 0 && most_voxels >= extent.x) {
    return {lo, {extent.x, lo.y + round_count(most_voxels / extent.x, extent.y - lo.y), lo.z + 1}};
  }
  return {lo, {lo.x + std::min(most_voxels, extent.x - lo.x), lo.y + 1, lo.z + 1}};
}

}  // namespace weir
