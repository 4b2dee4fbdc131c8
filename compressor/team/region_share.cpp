#include "compressor/team/region_share.h"

#include <algorithm>

namespace weir {

std::vector<Box> boxes_of_run(const Index3& count, const Share& run) {
  std::vector<Box> boxes;
  const std::int64_t plane = count.x * count.y;
  for (std::int64_t at = run.begin; at < run.end;) {
    const Index3 lo = index_at(at, count);
    const std::int64_t left = run.end - at;
    if (lo.x == 0 && lo.y == 0 && left >= plane) {
      boxes.push_back({lo, {count.x, count.y, lo.z + left / plane}});
    } else if (lo.x == 0 && left >= count.x) {
      boxes.push_back({lo, {count.x, std::min(count.y, lo.y + left / count.x), lo.z + 1}});
    } else {
      boxes.push_back({lo, {std::min(count.x, lo.x + left), lo.y + 1, lo.z + 1}});
    }
    at += boxes.back().voxels();
  }
  return boxes;
}

std::vector<Box> own_regions(const NodeLattice& regions, const Team& team) {
  return boxes_of_run(regions.count, team.share(regions.size()));
}

OwnLeaves::OwnLeaves(const NodeLattice& leaves, const Team& team) {
  const NodeLattice regions = make_lattice(leaves.domain, kLowerDim);
  const Box all{{0, 0, 0}, leaves.count};
  for (const Box& box : own_regions(regions, team)) {
    const Index3 lo = (regions.first + box.lo) * kLowerLeaves - leaves.first;
    const Index3 hi = (regions.first + box.hi) * kLowerLeaves - leaves.first;
    boxes_.push_back(intersect({lo, hi}, all));
  }
}

std::vector<Box> OwnLeaves::of(const Box& box) const {
  std::vector<Box> parts;
  for (const Box& own : boxes_) {
    const Box part = intersect(own, box);
    if (!part.empty()) parts.push_back(part);
  }
  return parts;
}

}  // namespace weir
