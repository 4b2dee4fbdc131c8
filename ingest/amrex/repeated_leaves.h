// Finds the leaves of a composited grid that repeat the values of coarse cells.
#pragma once

#include <span>
#include <vector>

#include "ingest/amrex/level_cover.h"
#include "ingest/amrex/plotfile.h"
#include "ingest/source/repeated_part.h"

namespace weir {

/// Cuts `box`, a box of cells of the last of `levels`, into parts of whole leaves, as far as they lie in the box.
/// Each leaf repeats by the cells of one level: the coarsest that is as fine as all values in the leaf and has cells
/// that fill the leaf. `cover` are the parts that give the box its values.
std::vector<RepeatedPart> repeated_leaves(std::span<const PlotfileLevel> levels, std::span<const CoverPart> cover,
                                          const Box& box);

}  // namespace weir
