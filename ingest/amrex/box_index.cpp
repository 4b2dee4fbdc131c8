#include "ingest/amrex/box_index.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace weir {
namespace {

bool touch(const CellBox& a, const Box& b) {
  return a.lo[0] < b.hi.x && a.last[0] >= b.lo.x && a.lo[1] < b.hi.y && a.last[1] >= b.lo.y && a.lo[2] < b.hi.z &&
         a.last[2] >= b.lo.z;
}

std::int64_t twice_centre(const CellBox& box, std::size_t axis) {
  return std::int64_t{box.lo.at(axis)} + box.last.at(axis);
}

}  // namespace

BoxIndex::BoxIndex(std::span<const CellBox> boxes) : boxes_(boxes), order_(boxes.size()) {
  std::iota(order_.begin(), order_.end(), 0U);
  if (!boxes.empty()) build(0, 0, boxes.size());
}

BoxIndex::Node BoxIndex::look_at(std::size_t begin, std::size_t end) const {
  Node node{boxes_[order_[begin]], 0};
  std::array<std::int64_t, 3> least_centre{};
  std::array<std::int64_t, 3> most_centre{};
  std::array<double, 3> lengths{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    least_centre.at(axis) = most_centre.at(axis) = twice_centre(node.bounds, axis);
  for (std::size_t i = begin; i < end; ++i) {
    const CellBox& box = boxes_[order_[i]];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      node.bounds.lo.at(axis) = std::min(node.bounds.lo.at(axis), box.lo.at(axis));
      node.bounds.last.at(axis) = std::max(node.bounds.last.at(axis), box.last.at(axis));
      least_centre.at(axis) = std::min(least_centre.at(axis), twice_centre(box, axis));
      most_centre.at(axis) = std::max(most_centre.at(axis), twice_centre(box, axis));
      lengths.at(axis) += static_cast<double>(std::int64_t{box.last.at(axis)} - box.lo.at(axis) + 1);
    }
  }
  const auto layers = [&](std::size_t axis) {
    return static_cast<double>(most_centre.at(axis) - least_centre.at(axis)) / lengths.at(axis);
  };
  for (std::size_t axis = 1; axis < 3; ++axis) {
    if (layers(axis) > layers(node.axis)) node.axis = axis;
  }
  return node;
}

void BoxIndex::build(std::size_t node, std::size_t begin, std::size_t end) {
  if (node >= bounds_.size()) bounds_.resize(node + 1);
  const auto [bounds, axis] = look_at(begin, end);
  bounds_[node] = bounds;
  if (end - begin <= kLeafBoxes) return;
  const std::size_t middle = std::midpoint(begin, end);
  const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
  const auto before = [this, along = axis](std::uint32_t a, std::uint32_t b) {
    return twice_centre(boxes_[a], along) < twice_centre(boxes_[b], along);
  };
  std::nth_element(at(begin), at(middle), at(end), before);
  build(2 * node + 1, begin, middle);
  build(2 * node + 2, middle, end);
}

std::size_t BoxIndex::find(const Box& box, std::vector<std::uint32_t>& found) const {
  return order_.empty() ? 0 : find(0, 0, order_.size(), box, found);
}

std::size_t BoxIndex::find(std::size_t node, std::size_t begin, std::size_t end, const Box& box,
                           std::vector<std::uint32_t>& found) const {
  if (!touch(bounds_[node], box)) return 1;
  if (end - begin <= kLeafBoxes) {
    for (std::size_t i = begin; i < end; ++i) {
      if (touch(boxes_[order_[i]], box)) found.push_back(order_[i]);
    }
    return 1;
  }
  const std::size_t middle = std::midpoint(begin, end);
  return 1 + find(2 * node + 1, begin, middle, box, found) + find(2 * node + 2, middle, end, box, found);
}

std::pair<std::uint32_t, std::uint32_t> BoxIndex::overlapping(Interruption interruption) const {
  std::vector<std::uint32_t> found;
  for (const std::uint32_t i : order_) {  // neighbouring boxes in turn take the same paths through the tree
    throw_if_interrupted(interruption);
    found.clear();
    find(boxes_[i].box(), found);
    for (const std::uint32_t other : found) {
      if (other != i) return {std::min(i, other), std::max(i, other)};
    }
  }
  return {0, 0};
}

}  // namespace weir
