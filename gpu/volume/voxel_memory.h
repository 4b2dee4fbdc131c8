// How much memory a grid takes while the CPU renders it, and how much of a packed grid is kept decoded.
#pragma once

#include <cstdint>
#include <optional>

#include "format/nanovdb/nvdb_grid.h"

namespace weir {

/// A ceiling for the memory of volumes: tables, tile values, macrocells and decoded blocks. The pages of a mapped
/// file belong to the page cache and do not count.
struct VoxelMemory {
  std::optional<std::uint64_t> ceiling = std::nullopt;  ///< bytes; none: what the machine has available
  std::uint64_t volumes = 1;                            ///< volumes that are held at a time and share the memory
  bool levels = false;                                  ///< keep an eighth for levels of detail
};

/// For a grid that is not packed and has no ceiling, only level_bytes is set.
struct VoxelPlan {
  std::uint64_t level_bytes = 0;             ///< for levels of detail, if they were asked for
  std::uint64_t fixed_bytes = 0;             ///< most bytes of table, tile values and macrocells
  std::uint64_t decoded_bytes = 0;           ///< bytes of all decoded blocks, counted only if they decide
  std::optional<std::uint64_t> cache_bytes;  ///< set if the decoded blocks of a packed grid do not fit
};

/// The smallest cache: about 250 blocks, as many as are around a few rays.
inline constexpr std::uint64_t kLeastCacheBytes = std::uint64_t{512} << 10U;

/// Plans decoded blocks if all of them fit, otherwise a cache of what the ceiling leaves. If the machine has less
/// than that available, plans a cache of half of it, because the file's pages and the picture need some. Throws
/// Error(usage) if a given ceiling does not hold the table and kLeastCacheBytes, Error(input) if the machine does
/// not, and the errors of leaf_lattice.
VoxelPlan plan_voxels(const NvdbGrid& grid, const VoxelMemory& memory);

}  // namespace weir
