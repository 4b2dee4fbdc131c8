#include "ingest/amrex/repeated_leaves.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace weir {
namespace {

/// Returns the leaves that have voxels of `box`.
Box leaves_of(const Box& box) {
  return {floor_div(box.lo, kLeafDim), floor_div(box.hi - Index3{1, 1, 1}, kLeafDim) + Index3{1, 1, 1}};
}

bool divides_leaf(const Index3& by) { return kLeafDim % by.x == 0 && kLeafDim % by.y == 0 && kLeafDim % by.z == 0; }

bool on_multiples(const Index3& i, const Index3& by) { return i.x % by.x == 0 && i.y % by.y == 0 && i.z % by.z == 0; }

/// Finds, for each leaf, the level by the cells of which its values repeat.
class LeafLevels {
 public:
  using Level = std::uint32_t;
  static constexpr Level kTaken = std::numeric_limits<Level>::max();

  LeafLevels(std::span<const PlotfileLevel> levels, std::span<const CoverPart> cover, const Box& box)
      : box_(box), leaves_(leaves_of(box)), levels_(static_cast<std::size_t>(leaves_.voxels())) {
    for (std::size_t level = 0; level < levels.size(); ++level)
      repeats_.push_back(refinement(levels, level, levels.size() - 1));
    for (const CoverPart& part : cover) {
      for_each_index(leaves_of(part.box),
                     [&](const Index3& leaf) { at(leaf) = std::max(at(leaf), static_cast<Level>(part.level)); });
    }
    for_each_index(leaves_, [&](const Index3& leaf) { at(leaf) = fitting(at(leaf), voxels({leaf, leaf + kOne})); });
  }

  std::vector<RepeatedPart> take_parts() {
    std::vector<RepeatedPart> parts;
    for_each_index(leaves_, [&](const Index3& leaf) {
      const Level level = at(leaf);
      if (level == kTaken) return;
      Box part{leaf, leaf + kOne};
      const auto all_alike = [&](const Box& more) {
        bool alike = true;
        for_each_index(more, [&](const Index3& i) { alike = alike && at(i) == level; });
        return alike;
      };
      while (part.hi.x < leaves_.hi.x && at({part.hi.x, leaf.y, leaf.z}) == level) ++part.hi.x;
      while (part.hi.y < leaves_.hi.y &&
             all_alike({{part.lo.x, part.hi.y, leaf.z}, {part.hi.x, part.hi.y + 1, leaf.z + 1}}))
        ++part.hi.y;
      while (part.hi.z < leaves_.hi.z &&
             all_alike({{part.lo.x, part.lo.y, part.hi.z}, {part.hi.x, part.hi.y, part.hi.z + 1}}))
        ++part.hi.z;
      for_each_index(part, [&](const Index3& i) { at(i) = kTaken; });
      parts.push_back({voxels(part), repeats_[level]});
    });
    return parts;
  }

 private:
  static constexpr Index3 kOne{1, 1, 1};

  Level& at(const Index3& leaf) {
    return levels_[static_cast<std::size_t>(linear_index(leaf - leaves_.lo, leaves_.extent()))];
  }
  Box voxels(const Box& leaves) const { return intersect({leaves.lo * kLeafDim, leaves.hi * kLeafDim}, box_); }

  /// Returns the coarsest level, from `level` on, whose cells fill `inside` exactly and divide a leaf. `inside` is
  /// the part of a leaf in the box.
  Level fitting(Level level, const Box& inside) const {
    while (!divides_leaf(repeats_[level]) || !on_multiples(inside.lo, repeats_[level]) ||
           !on_multiples(inside.hi, repeats_[level]))
      ++level;
    return level;
  }

  Box box_;
  Box leaves_;
  std::vector<Index3> repeats_;  ///< for each level, voxels along one of its cells
  std::vector<Level> levels_;    ///< for each leaf, x fastest
};

}  // namespace

std::vector<RepeatedPart> repeated_leaves(std::span<const PlotfileLevel> levels, std::span<const CoverPart> cover,
                                          const Box& box) {
  return LeafLevels(levels, cover, box).take_parts();
}

}  // namespace weir
