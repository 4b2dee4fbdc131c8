#include "ingest/hdf5/storage/box_cuts.h"

#include <algorithm>

namespace weir {
namespace {}  // namespace

BoxCuts::BoxCuts(const Box& box, const Index3& unit, const Index3& corner, std::int64_t voxels)
    : box_(box), part_(unit) {
  const auto floored = [](std::int64_t lo, std::int64_t step, std::int64_t from) {
    return from + floor_div(lo - from, step) * step;
  };
  first_ = {floored(box.lo.x, unit.x, corner.x), floored(box.lo.y, unit.y, corner.y),
            floored(box.lo.z, unit.z, corner.z)};
  const Index3 span = box.hi - first_;
  const auto grow = [&](std::int64_t& edge, std::int64_t all) {
    const std::int64_t one = volume(min(part_, box.extent()));
    edge *= std::clamp<std::int64_t>(voxels / one, 1, ceil_div(all, edge));
    return edge >= all;
  };
  if (grow(part_.x, span.x) && grow(part_.y, span.y)) grow(part_.z, span.z);
  count_ = {ceil_div(span.x, part_.x), ceil_div(span.y, part_.y), ceil_div(span.z, part_.z)};
}

Box BoxCuts::part(std::int64_t i) const {
  const Index3 at = index_at(i, count_);
  const Index3 lo = first_ + Index3{at.x * part_.x, at.y * part_.y, at.z * part_.z};
  return intersect({lo, lo + part_}, box_);
}

}  // namespace weir
