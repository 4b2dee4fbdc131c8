#include "ingest/hdf5/virtual/coverage.h"

#include <algorithm>
#include <cstddef>

namespace weir {
namespace {

using Covers = std::vector<const AxisBox*>;

// Sweeps along `axis` through the edges of `covers`, which hold `point` on all axes before. Counts the elements that
// no cover holds; `found` gets the first such element of the whole sweep.
std::uint64_t count_gaps(const AxisBox& whole, std::size_t axis, Covers covers, std::vector<hsize_t>& point,
                         Uncovered& found) {
  if (axis == whole.lo.size()) {
    if (!covers.empty()) return 0;
    if (found.first.empty()) found.first = point;
    return 1;
  }
  std::vector<hsize_t> edges{whole.lo[axis], whole.hi[axis]};
  for (const AxisBox* box : covers) {
    for (const hsize_t edge : {box->lo[axis], box->hi[axis]}) {
      if (edge > whole.lo[axis] && edge < whole.hi[axis]) edges.push_back(edge);
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::sort(covers.begin(), covers.end(),
            [&](const AxisBox* a, const AxisBox* b) { return a->lo[axis] < b->lo[axis]; });

  std::uint64_t count = 0;
  Covers active;
  auto next = covers.begin();
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const hsize_t edge = edges[i];
    std::erase_if(active, [&](const AxisBox* box) { return box->hi[axis] <= edge; });
    for (; next != covers.end() && (*next)->lo[axis] <= edge; ++next) {
      if ((*next)->hi[axis] > edge) active.push_back(*next);
    }
    point[axis] = edge;
    count += (edges[i + 1] - edge) * count_gaps(whole, axis + 1, active, point, found);
  }
  return count;
}

}  // namespace

Uncovered uncovered(const AxisBox& whole, std::span<const AxisBox> covers) {
  Covers all;
  for (const AxisBox& box : covers) all.push_back(&box);
  Uncovered found;
  std::vector<hsize_t> point = whole.lo;
  found.count = count_gaps(whole, 0, std::move(all), point, found);
  return found;
}

}  // namespace weir
