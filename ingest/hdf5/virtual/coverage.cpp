#include "ingest/hdf5/virtual/coverage.h"

#include <algorithm>
#include <cstddef>

namespace weir {
namespace {

using Covers = std::vector<const AxisBox*>;

// Sweeps along `axis` through the edges of `covers`, which hold `point` on all axes before; true where an element
// is left, which is then in `point`.
bool find_gap(const AxisBox& whole, std::size_t axis, Covers covers, std::vector<hsize_t>& point) {
  if (axis == whole.lo.size()) return covers.empty();
  std::vector<hsize_t> edges{whole.lo[axis]};
  for (const AxisBox* box : covers) {
    for (const hsize_t edge : {box->lo[axis], box->hi[axis]}) {
      if (edge > whole.lo[axis] && edge < whole.hi[axis]) edges.push_back(edge);
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::sort(covers.begin(), covers.end(),
            [&](const AxisBox* a, const AxisBox* b) { return a->lo[axis] < b->lo[axis]; });

  Covers active;
  auto next = covers.begin();
  for (const hsize_t edge : edges) {
    std::erase_if(active, [&](const AxisBox* box) { return box->hi[axis] <= edge; });
    for (; next != covers.end() && (*next)->lo[axis] <= edge; ++next) {
      if ((*next)->hi[axis] > edge) active.push_back(*next);
    }
    point[axis] = edge;
    std::copy(whole.lo.begin() + static_cast<std::ptrdiff_t>(axis) + 1, whole.lo.end(),
              point.begin() + static_cast<std::ptrdiff_t>(axis) + 1);
    if (active.empty() || find_gap(whole, axis + 1, active, point)) return true;
  }
  return false;
}

}  // namespace

std::optional<std::vector<hsize_t>> first_uncovered(const AxisBox& whole, std::span<const AxisBox> covers) {
  Covers all;
  for (const AxisBox& box : covers) all.push_back(&box);
  std::vector<hsize_t> point = whole.lo;
  if (find_gap(whole, 0, std::move(all), point)) return point;
  return std::nullopt;
}

}  // namespace weir
