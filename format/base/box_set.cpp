#include "format/base/box_set.h"

#include <array>
#include <optional>

namespace weir {
namespace {

// The box of both where they share a whole side.
std::optional<Box> joined(const Box& a, const Box& b) {
  const Box all{min(a.lo, b.lo), max(a.hi, b.hi)};
  if (all.voxels() != a.voxels() + b.voxels()) return std::nullopt;
  return all;
}

// Adds what of `box` lies outside `hole` to `rest`: whole layers below and above it, then rows, then what is left.
void cut(const Box& box, const Box& hole, std::vector<Box>& rest) {
  const Box inner = intersect(box, hole);
  if (inner.empty()) {
    rest.push_back(box);
    return;
  }
  const std::array<Box, 6> sides{{
      {box.lo, {box.hi.x, box.hi.y, inner.lo.z}},
      {{box.lo.x, box.lo.y, inner.lo.z}, {box.hi.x, inner.lo.y, inner.hi.z}},
      {{box.lo.x, inner.lo.y, inner.lo.z}, {inner.lo.x, inner.hi.y, inner.hi.z}},
      {{inner.hi.x, inner.lo.y, inner.lo.z}, {box.hi.x, inner.hi.y, inner.hi.z}},
      {{box.lo.x, inner.hi.y, inner.lo.z}, {box.hi.x, box.hi.y, inner.hi.z}},
      {{box.lo.x, box.lo.y, inner.hi.z}, box.hi},
  }};
  for (const Box& side : sides) {
    if (!side.empty()) rest.push_back(side);
  }
}

}  // namespace

std::int64_t BoxSet::size() const {
  std::int64_t positions = 0;
  for (const Box& box : boxes_) positions += box.voxels();
  return positions;
}

void BoxSet::add(const Box& box) {
  boxes_.push_back(box);
  while (boxes_.size() > 1) {
    const std::optional<Box> both = joined(boxes_[boxes_.size() - 2], boxes_.back());
    if (!both) return;
    boxes_.pop_back();
    boxes_.back() = *both;
  }
}

std::vector<Box> BoxSet::missing_from(const Box& box) const {
  std::vector<Box> rest{box};
  std::vector<Box> next;
  for (const Box& hole : boxes_) {
    next.clear();
    for (const Box& piece : rest) cut(piece, hole, next);
    rest.swap(next);
  }
  return rest;
}

}  // namespace weir
