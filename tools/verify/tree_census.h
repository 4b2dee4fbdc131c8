// Counts what a grid really holds by visiting every leaf and tile. `verify` compares the stored figures with it, and
// `inspect` shows it. For a packed grid, nodes, tiles and active voxels are the tree's, which is what other readers
// see; values are those of the packed data.
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
  std::array<std::uint64_t, 6> leaves_by_bits{};  ///< leaves of 1, 2, 4, 8, 16 and 32 bits per voxel
  std::array<std::uint64_t, 3> active_tiles{};    ///< active tiles of 8^3, 128^3, 4096^3 voxels
  std::array<std::uint64_t, 3> inactive_tiles{};  ///< inactive tiles, same sizes; includes background outside the
                                                  ///< domain
  std::uint64_t active_voxels = 0;                ///< in leaves and active tiles
  std::uint64_t valued_voxels = 0;                ///< voxels with a counted value; all voxels of a packed grid
  std::uint64_t nonfinite = 0;                    ///< valued voxels that are NaN or infinite
  std::uint64_t zeros = 0;                        ///< valued voxels that are 0
  std::uint64_t backgrounds = 0;                  ///< valued voxels that have the background value, if that is finite
  std::uint64_t quiet_voxels = 0;                 ///< voxels in the index box in inactive tiles of the background; not
                                                  ///< valued
  Box active_bbox;                                ///< half open; {} without active voxels
  float min = std::numeric_limits<float>::infinity();  ///< of the finite active values
  float max = -std::numeric_limits<float>::infinity();
  std::optional<Index3> outside_macrocell;  ///< a block in the domain with a value outside the bounds of its macrocell
  std::optional<Index3> outside_apron;      ///< lowest voxel of a macrocell whose bounds do not hold a value of its
                                            ///< apron
};

/// Called from the calling thread with the number of leaves (for a packed grid: coded blocks) done so far; may throw
/// to stop.
using CensusProgress = std::function<void(std::uint64_t leaves)>;

/// Decodes every block, on all threads of TBB. `trace` receives what each thread decodes, in float32 bytes. Throws as
/// NvdbGrid::for_each_block and decode_block.
TreeCensus take_census(const NvdbGrid& grid, const CensusProgress& progress, Trace* trace = nullptr);

/// Returns an upper bound of the coded blocks that take_census and count_values visit.
std::uint64_t census_blocks(const NvdbGrid& grid);

/// Counts the active values in `bins` equal bins over [lo, hi], lo < hi; values outside and NaN are not counted.
/// Decodes every block, on all threads of TBB. Throws as take_census.
std::vector<std::uint64_t> count_values(const NvdbGrid& grid, float lo, float hi, std::size_t bins,
                                        const CensusProgress& progress);

/// Returns the histogram of the finite values between the ends of `range`. If either end is not finite, both are
/// replaced by the least and largest finite value. Has one bin if all values are equal, and no bin between NaN if there
/// is no finite value.
Sidecar::Histogram finite_histogram(const NvdbGrid& grid, const MinMax& range, std::size_t bins,
                                    const CensusProgress& progress);

}  // namespace weir
