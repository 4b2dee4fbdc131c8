// What a grid really holds, counted by visiting every leaf and tile: `verify` compares the stored figures with it, and
// `inspect` shows it. Of a packed grid the nodes, tiles and active voxels are the tree's, which is what other readers
// see, and values are those of the packed data.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "format/base/index.h"
#include "format/base/trace.h"
#include "format/leaf/bounds.h"
#include "format/nanovdb/nvdb_grid.h"
#include "format/sidecar/sidecar.h"

namespace weir {

struct TreeCensus {
  std::uint64_t leaves = 0;
  std::array<std::uint64_t, 6> leaves_by_bits{};  ///< of 1, 2, 4, 8, 16 and 32 bits a voxel
  std::array<std::uint64_t, 3> active_tiles{};    ///< of 8^3, 128^3, 4096^3 voxels
  std::array<std::uint64_t, 3> inactive_tiles{};  ///< the same; background outside the domain included
  std::uint64_t active_voxels = 0;                ///< in leaves and active tiles
  std::uint64_t valued_voxels = 0;                ///< those that the figures of values are of: all, where packed
  std::uint64_t nonfinite = 0;                    ///< of them, those that are NaN or infinite
  std::uint64_t zeros = 0;                        ///< of them, those that are 0
  std::uint64_t backgrounds = 0;                  ///< of them, the finite ones that are the background
  std::uint64_t quiet_voxels = 0;                 ///< in the index box, inactive tiles of the background: not valued
  Box active_bbox;                                ///< half open; {} without active voxels
  float min = std::numeric_limits<float>::infinity();  ///< of the finite active values
  float max = -std::numeric_limits<float>::infinity();
  std::optional<Index3> outside_macrocell;  ///< a block in the domain with a value its macrocell does not hold
  std::optional<Index3> outside_apron;      ///< lowest voxel of a macrocell that does not hold a value of its apron
};

/// Called with the number of leaves (of a packed grid: of coded blocks) done so far, from the calling thread; may throw
/// to stop.
using CensusProgress = std::function<void(std::uint64_t leaves)>;

/// Decodes every block, on all threads of TBB. `trace` gets what each of them decodes, in float32 bytes. Throws as
/// NvdbGrid::for_each_block and decode_block.
TreeCensus take_census(const NvdbGrid& grid, const CensusProgress& progress, Trace* trace = nullptr);

/// The most coded blocks that take_census and count_values can find.
std::uint64_t census_blocks(const NvdbGrid& grid);

/// Counts of the active values in `bins` equal bins over [lo, hi], lo < hi; what lies outside or is
/// NaN is not counted. Decodes every block, on all threads of TBB. Throws as take_census.
std::vector<std::uint64_t> count_values(const NvdbGrid& grid, float lo, float hi, std::size_t bins,
                                        const CensusProgress& progress);

/// The same of the finite values, between the ends of `range` or, where one of these is not finite, their own: one bin
/// where they are one value, and none, between NaN, where there are none.
Sidecar::Histogram finite_histogram(const NvdbGrid& grid, const MinMax& range, std::size_t bins,
                                    const CensusProgress& progress);

}  // namespace weir
