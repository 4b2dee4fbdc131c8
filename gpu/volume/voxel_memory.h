// How much memory a grid takes while the CPU renders it, and what of a packed one is kept decoded.
#pragma once

#include <cstdint>
#include <optional>

#include "format/nanovdb/nvdb_grid.h"

namespace weir {

/// A ceiling of what volumes take in memory: tables, tile values, macrocells and decoded blocks. The pages of a mapped
/// file are the page cache's and do not count.
struct VoxelMemory {
  std::optional<std::uint64_t> ceiling = std::nullopt;  ///< bytes; none: what the machine has available
  std::uint64_t volumes = 1;                            ///< that are held at a time and share it
  bool levels = false;                                  ///< an eighth is kept for levels of detail
};

/// Of a grid that is not packed and has no ceiling, levels alone.
struct VoxelPlan {
  std::uint64_t level_bytes = 0;             ///< for levels of detail, where they were asked for
  std::uint64_t fixed_bytes = 0;             ///< table, tile values and macrocells, at most
  std::uint64_t decoded_bytes = 0;           ///< of all decoded blocks, where their number decides
  std::optional<std::uint64_t> cache_bytes;  ///< of a packed grid whose decoded blocks do not fit; else none
};

/// The smallest cache: some 250 blocks, those around a few rays.
inline constexpr std::uint64_t kLeastCacheBytes = std::uint64_t{512} << 10U;

/// Decoded blocks where they all fit, else a cache of what the ceiling leaves; where the machine has less than that, of
/// half of what it has available, since the file's own pages and the picture need some of it. Throws Error(usage) where
/// a given ceiling holds no table and kLeastCacheBytes, Error(input) where the machine does not, and as leaf_lattice.
VoxelPlan plan_voxels(const NvdbGrid& grid, const VoxelMemory& memory);

}  // namespace weir
