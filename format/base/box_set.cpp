#include "format/base/box_set.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>
#include <utility>

namespace weir {
namespace {

constexpr std::array<std::int64_t Index3::*, 3> kBoxAxes{&Index3::x, &Index3::y, &Index3::z};

// Returns the union of two boxes if it is a box, that is if they share a whole side.
std::optional<Box> joined(const Box& a, const Box& b) {
  const Box all{min(a.lo, b.lo), max(a.hi, b.hi)};
  if (all.voxels() != a.voxels() + b.voxels()) return std::nullopt;
  return all;
}

// Adds the part of `box` outside `hole` to `rest`: first whole layers below and above it, then rows, then the
// remainder.
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

// Halves a box, and its halves, until each part lies inside all of the boxes that reach into it. It cuts at the median
// of the boxes' faces, as a k-d tree does, so that the cuts fall on the borders of a regular decomposition and split
// none of its boxes.
class CoverageSearch {
 public:
  explicit CoverageSearch(std::span<const Box> boxes) : boxes_(boxes), repeated_(boxes.size()) {}

  Coverage run(const Box& whole) {
    std::vector<std::size_t> all(boxes_.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    search(whole, those_in(whole, all));
    if (repeated_ < boxes_.size()) return {repeated_, {}};
    std::vector<Box> missing = missing_.boxes();
    std::ranges::sort(missing, {}, [](const Box& box) { return std::tuple(box.lo.z, box.lo.y, box.lo.x); });
    return {std::nullopt, std::move(missing)};
  }

 private:
  // `reaching`: ascending indices of the boxes that reach into `part`.
  void search(const Box& part, const std::vector<std::size_t>& reaching) {
    if (repeated_ < boxes_.size() && reaching.size() < 2) return;
    if (reaching.empty()) return missing_.add(part);
    Box low = part;
    Box high = part;
    if (!halve(reaching, low, high)) {
      if (reaching.size() > 1) repeated_ = reaching[1];
      return;
    }
    search(low, those_in(low, reaching));
    search(high, those_in(high, reaching));
  }

  // Returns the boxes of `among` that reach into `part`, except those after a box that is known to be repeated.
  std::vector<std::size_t> those_in(const Box& part, const std::vector<std::size_t>& among) const {
    std::vector<std::size_t> reaching;
    for (const std::size_t i : among) {
      if (i < repeated_ && !intersect(boxes_[i], part).empty()) reaching.push_back(i);
    }
    return reaching;
  }

  // `low` and `high` are the same box on entry and become its halves. Returns false if no face of a box lies inside it.
  bool halve(const std::vector<std::size_t>& reaching, Box& low, Box& high) {
    for (std::vector<std::int64_t>& faces : faces_) faces.clear();
    for (const std::size_t i : reaching) {
      for (std::size_t a = 0; a < kBoxAxes.size(); ++a) {
        const auto axis = kBoxAxes[a];
        for (const std::int64_t face : {boxes_[i].lo.*axis, boxes_[i].hi.*axis}) {
          if (face > low.lo.*axis && face < low.hi.*axis) faces_[a].push_back(face);
        }
      }
    }
    const auto most = std::ranges::max_element(faces_, {}, [](const auto& faces) { return faces.size(); });
    if (most->empty()) return false;
    const auto middle = most->begin() + std::ssize(*most) / 2;
    std::ranges::nth_element(*most, middle);
    const auto axis = kBoxAxes[static_cast<std::size_t>(most - faces_.begin())];
    low.hi.*axis = high.lo.*axis = *middle;
    return true;
  }

  std::span<const Box> boxes_;
  std::size_t repeated_;  // the first repeated box that is known; boxes_.size() if none is
  BoxSet missing_;
  std::array<std::vector<std::int64_t>, 3> faces_;  // room for halve()
};

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

Coverage coverage_of(const Box& whole, std::span<const Box> boxes) { return CoverageSearch(boxes).run(whole); }

}  // namespace weir
