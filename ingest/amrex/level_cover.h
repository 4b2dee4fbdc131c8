// Finds the boxes and levels that give a box of the composited grid its values: the finest level that has cells
// there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "format/base/index.h"
#include "ingest/amrex/plotfile.h"

namespace weir {

/// A part of a box of cells of the wanted level, and the box that has its cells, on the wanted level or a coarser
/// one.
struct CoverPart {
  std::size_t level = 0;
  std::uint32_t fab = 0;  ///< position of the box on its level
  Box box;                ///< in cells of the wanted level, not empty
};

struct LevelCover {
  std::vector<CoverPart> parts;
  std::vector<Box> rest;  ///< cells that no requested level has
};

/// Returns the cells of level `fine` along one cell of level `coarse`, which is not finer.
Index3 refinement(std::span<const PlotfileLevel> levels, std::size_t coarse, std::size_t fine);

constexpr Box refined(const Box& box, const Index3& by) {
  return {{box.lo.x * by.x, box.lo.y * by.y, box.lo.z * by.z}, {box.hi.x * by.x, box.hi.y * by.y, box.hi.z * by.z}};
}
/// Returns the coarse cells that lie wholly in `box`, a box of fine cells. The result may be empty.
constexpr Box inner_cells(const Box& box, const Index3& by) {
  return {{ceil_div(box.lo.x, by.x), ceil_div(box.lo.y, by.y), ceil_div(box.lo.z, by.z)},
          {box.hi.x / by.x, box.hi.y / by.y, box.hi.z / by.z}};
}
/// Returns the coarse cells that overlap `box`, a box of fine cells with indices >= 0.
constexpr Box coarsened(const Box& box, const Index3& by) {
  return {{box.lo.x / by.x, box.lo.y / by.y, box.lo.z / by.z},
          {ceil_div(box.hi.x, by.x), ceil_div(box.hi.y, by.y), ceil_div(box.hi.z, by.z)}};
}

/// Bytes that own_parts holds for each box of finer levels in its box: the positions of boxes, in vectors with room
/// for twice as many, also for the halves into which it cuts the box.
inline constexpr std::uint64_t kBytesPerFinerBox = 16;

/// Returns the cells of `box` that are the own cells of level `level`: its boxes have them, and no single box of a
/// level from the next finer one up to `finest` covers the whole cell. The parts are in disk order. Takes as much time
/// as cover_box.
std::vector<CoverPart> own_parts(std::span<const PlotfileLevel> levels, std::size_t level, std::size_t finest,
                                 const Box& box);

/// Cuts `box`, a box of cells of level `wanted`, into parts. Each part lies in one box of the finest level, from
/// `wanted` down to `coarsest`, that has cells there. The parts are in disk order. The time depends on the number of
/// parts, not on the number of all boxes.
LevelCover cover_box(std::span<const PlotfileLevel> levels, std::size_t wanted, std::size_t coarsest, const Box& box);

}  // namespace weir
