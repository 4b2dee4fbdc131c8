// Which boxes of which levels give a box of the composited grid its values: the finest level that has cells there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "format/base/index.h"
#include "ingest/amrex/plotfile.h"

namespace weir {

/// A part of a box of cells of the wanted level, and the box of its own or a coarser level that has these cells.
struct CoverPart {
  std::size_t level = 0;
  std::uint32_t fab = 0;  ///< box of that level
  Box box;                ///< in cells of the wanted level, not empty
};

struct LevelCover {
  std::vector<CoverPart> parts;
  std::vector<Box> rest;  ///< what no level asked for has
};

/// Cells of level `fine` along one of level `coarse`, which is no finer.
Index3 refinement(std::span<const PlotfileLevel> levels, std::size_t coarse, std::size_t fine);

constexpr Box refined(const Box& box, const Index3& by) {
  return {{box.lo.x * by.x, box.lo.y * by.y, box.lo.z * by.z}, {box.hi.x * by.x, box.hi.y * by.y, box.hi.z * by.z}};
}
/// The coarse cells all of whose fine ones are in `box`; may be empty.
constexpr Box inner_cells(const Box& box, const Index3& by) {
  return {{ceil_div(box.lo.x, by.x), ceil_div(box.lo.y, by.y), ceil_div(box.lo.z, by.z)},
          {box.hi.x / by.x, box.hi.y / by.y, box.hi.z / by.z}};
}
/// The coarse cells that have fine ones in `box`, whose indices are 0 or more.
constexpr Box coarsened(const Box& box, const Index3& by) {
  return {{box.lo.x / by.x, box.lo.y / by.y, box.lo.z / by.z},
          {ceil_div(box.hi.x, by.x), ceil_div(box.hi.y, by.y), ceil_div(box.hi.z, by.z)}};
}

/// Bytes that own_parts holds for each box of finer levels in its box: their positions, in vectors with room for twice
/// as many, and those of the halves that it cuts them into.
inline constexpr std::uint64_t kBytesPerFinerBox = 16;

/// The cells of `box`, of cells of level `level`, that are its own: its boxes have them, and no box of a level from the
/// next finer one to `finest` has all of one. In the order in which they lie on disk; takes time as cover_box.
std::vector<CoverPart> own_parts(std::span<const PlotfileLevel> levels, std::size_t level, std::size_t finest,
                                 const Box& box);

/// Cuts `box`, of cells of level `wanted`, into parts of which each is of one box of the finest level from `wanted`
/// down to `coarsest` that has cells there; in the order in which they lie on disk. Takes time by the number of parts,
/// not by that of all boxes.
LevelCover cover_box(std::span<const PlotfileLevel> levels, std::size_t wanted, std::size_t coarsest, const Box& box);

}  // namespace weir
