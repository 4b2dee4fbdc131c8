#include "ingest/amrex/box_index.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace weir {
namespace {

bool touch(const CellBox& a, const Box& b) {
  return a.lo[0] < b.hi.x && a.last[0] >= b.lo.x && a.lo[1] < b.hi.y && a.last[1] >= b.lo.y && a.lo[2] < b.hi.z &&
         a.last[2] >= b.lo.z;
}

}  // namespace

BoxIndex::BoxIndex(std::span<const CellBox> boxes) : boxes_(boxes), order_(boxes.size()) {
  std::iota(order_.begin(), order_.end(), 0U);
  if (!boxes.empty()) build(0, 0, boxes.size());
}

CellBox BoxIndex::bounds_of(std::size_t begin, std::size_t end) const {
  CellBox bounds = boxes_[order_[begin]];
  for (std::size_t i = begin + 1; i < end; ++i) {
    const CellBox& box = boxes_[order_[i]];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      bounds.lo.at(axis) = std::min(bounds.lo.at(axis), box.lo.at(axis));
      bounds.last.at(axis) = std::max(bounds.last.at(axis), box.last.at(axis));
    }
  }
  return bounds;
}

// Halves the boxes by their position along the longest axis of their bounds.
void BoxIndex::build(std::size_t node, std::size_t begin, std::size_t end) {
  if (node >= bounds_.size()) bounds_.resize(node + 1);
  const CellBox bounds = bounds_of(begin, end);
  bounds_[node] = bounds;
  if (end - begin <= kLeafBoxes) return;
  std::size_t axis = 0;
  const auto length = [&](std::size_t a) { return std::int64_t{bounds.last.at(a)} - bounds.lo.at(a); };
  for (std::size_t a = 1; a < 3; ++a) {
    if (length(a) > length(axis)) axis = a;
  }
  const std::size_t middle = std::midpoint(begin, end);
  const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end),
                   [&](std::uint32_t a, std::uint32_t b) { return boxes_[a].lo.at(axis) < boxes_[b].lo.at(axis); });
  build(2 * node + 1, begin, middle);
  build(2 * node + 2, middle, end);
}

void BoxIndex::find(const Box& box, std::vector<std::uint32_t>& found) const {
  if (!order_.empty()) find(0, 0, order_.size(), box, found);
}

void BoxIndex::find(std::size_t node, std::size_t begin, std::size_t end, const Box& box,
                    std::vector<std::uint32_t>& found) const {
  if (!touch(bounds_[node], box)) return;
  if (end - begin <= kLeafBoxes) {
    for (std::size_t i = begin; i < end; ++i) {
      if (touch(boxes_[order_[i]], box)) found.push_back(order_[i]);
    }
    return;
  }
  const std::size_t middle = std::midpoint(begin, end);
  find(2 * node + 1, begin, middle, box, found);
  find(2 * node + 2, middle, end, box, found);
}

std::pair<std::uint32_t, std::uint32_t> BoxIndex::overlapping() const {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < boxes_.size(); ++i) {
    found.clear();
    find(boxes_[i].box(), found);
    for (const std::uint32_t other : found) {
      if (other != i) return {std::min(i, other), std::max(i, other)};
    }
  }
  return {0, 0};
}

}  // namespace weir
