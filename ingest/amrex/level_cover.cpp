#include "ingest/amrex/level_cover.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <tuple>
#include <utility>

namespace weir {
namespace {

std::int64_t& coordinate(Index3& i, std::size_t axis) { return axis == 0 ? i.x : axis == 1 ? i.y : i.z; }
std::int64_t coordinate(const Index3& i, std::size_t axis) { return axis == 0 ? i.x : axis == 1 ? i.y : i.z; }

struct Cut {
  std::size_t axis = 0;
  std::int64_t at = 0;
};

std::array<Box, 2> halves(const Box& box, const Cut& cut) {
  std::array<Box, 2> parts{box, box};
  coordinate(parts[0].hi, cut.axis) = cut.at;
  coordinate(parts[1].lo, cut.axis) = cut.at;
  return parts;
}

class Coverer {
 public:
  Coverer(std::span<const PlotfileLevel> levels, std::size_t wanted, std::size_t coarsest, bool keeps_rest)
      : levels_(levels), wanted_(wanted), coarsest_(coarsest), keeps_rest_(keeps_rest) {}

  /// Covers `box`, a box of cells of the wanted level, with the boxes of `level` and of coarser levels. Of a box that
  /// is finer than the wanted level, only the wanted cells that it covers wholly count.
  void cover(std::size_t level, const Box& box) {
    std::vector<std::uint32_t> found;
    if (level <= wanted_) {
      levels_[level].index.find(coarsened(box, refinement(levels_, level, wanted_)), found);
    } else {
      levels_[level].index.find(refined(box, refinement(levels_, wanted_, level)), found);
      std::erase_if(found, [&](std::uint32_t fab) { return intersect(box_of(level, fab), box).empty(); });
    }
    cover_by(level, box, found);
  }

  LevelCover take() { return std::move(cover_); }

 private:
  void below(std::size_t level, const Box& box) {
    if (level > coarsest_) return cover(level - 1, box);
    if (keeps_rest_) cover_.rest.push_back(box);
  }

  Box box_of(std::size_t level, std::uint32_t fab) const {
    if (level > wanted_) return inner_cells(levels_[level].boxes[fab].box(), refinement(levels_, wanted_, level));
    return refined(levels_[level].boxes[fab].box(), refinement(levels_, level, wanted_));
  }

  /// `fabs` are all boxes of `level` that have cells in `box`.
  void cover_by(std::size_t level, Box box, const std::vector<std::uint32_t>& fabs) {
    if (fabs.empty()) return below(level, box);
    if (fabs.size() > 1) return split(level, box, fabs);
    const Box fab = box_of(level, fabs.front());
    const Box part = intersect(fab, box);
    if (level <= wanted_) cover_.parts.push_back({level, fabs.front(), part});
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (coordinate(part.lo, axis) > coordinate(box.lo, axis)) {
        const auto [outside, inside] = halves(box, {axis, coordinate(part.lo, axis)});
        below(level, outside);
        box = inside;
      }
      if (coordinate(part.hi, axis) < coordinate(box.hi, axis)) {
        const auto [inside, outside] = halves(box, {axis, coordinate(part.hi, axis)});
        below(level, outside);
        box = inside;
      }
    }
  }

  /// Cuts `box` at a face of one of the `fabs`, the face nearest to the middle. Such a face exists, because the
  /// several `fabs` share no cell.
  void split(std::size_t level, const Box& box, const std::vector<std::uint32_t>& fabs) {
    Cut best;
    double least = 2;
    for (const std::uint32_t fab : fabs) {
      const Box of_fab = box_of(level, fab);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const std::int64_t at : {coordinate(of_fab.lo, axis), coordinate(of_fab.hi, axis)}) {
          const std::int64_t lo = coordinate(box.lo, axis);
          const std::int64_t hi = coordinate(box.hi, axis);
          if (at <= lo || at >= hi) continue;
          const double off = static_cast<double>(std::abs(2 * at - lo - hi)) / static_cast<double>(hi - lo);
          if (off < least) {
            least = off;
            best = {axis, at};
          }
        }
      }
    }
    for (const Box& half : halves(box, best)) {
      std::vector<std::uint32_t> inside;
      std::copy_if(fabs.begin(), fabs.end(), std::back_inserter(inside),
                   [&](std::uint32_t fab) { return !intersect(box_of(level, fab), half).empty(); });
      cover_by(level, half, inside);
    }
  }

  std::span<const PlotfileLevel> levels_;
  std::size_t wanted_;
  std::size_t coarsest_;
  bool keeps_rest_;  // whether boxes of cells that no level has are kept
  LevelCover cover_;
};

}  // namespace

Index3 refinement(std::span<const PlotfileLevel> levels, std::size_t coarse, std::size_t fine) {
  Index3 by{1, 1, 1};
  for (std::size_t level = coarse + 1; level <= fine; ++level) {
    const Index3& ratio = levels[level].ratio;
    by = {by.x * ratio.x, by.y * ratio.y, by.z * ratio.z};
  }
  return by;
}

namespace {

void sort_by_place(std::span<const PlotfileLevel> levels, std::vector<CoverPart>& parts) {
  const auto place = [&](const CoverPart& part) {
    const FabPlace& fab = levels[part.level].places[part.fab];
    return std::tuple(part.level, fab.file, fab.offset, part.fab, part.box.lo.z, part.box.lo.y, part.box.lo.x);
  };
  std::sort(parts.begin(), parts.end(), [&](const CoverPart& a, const CoverPart& b) { return place(a) < place(b); });
}

}  // namespace

std::vector<CoverPart> own_parts(std::span<const PlotfileLevel> levels, std::size_t level, std::size_t finest,
                                 const Box& box) {
  Coverer coverer(levels, level, level, false);
  coverer.cover(finest, box);
  LevelCover cover = coverer.take();
  sort_by_place(levels, cover.parts);
  return std::move(cover.parts);
}

LevelCover cover_box(std::span<const PlotfileLevel> levels, std::size_t wanted, std::size_t coarsest, const Box& box) {
  Coverer coverer(levels, wanted, coarsest, true);
  coverer.cover(wanted, box);
  LevelCover cover = coverer.take();
  sort_by_place(levels, cover.parts);
  return cover;
}

}  // namespace weir
