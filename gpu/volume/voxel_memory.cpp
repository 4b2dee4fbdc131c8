#include "gpu/volume/voxel_memory.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/layout/nanovdb_layout.h"
#include "format/nanovdb/macrocells.h"
#include "format/process/process_memory.h"
#include "gpu/volume/decoded_leaves.h"
#include "gpu/volume/leaf_table.h"
#include "gpu/volume/macrocell_grid.h"

namespace weir {

namespace {

std::uint64_t tile_bytes(const NvdbGrid& grid) {
  if (grid.packed() != nullptr) return most_packed_tiles(*grid.packed()) * sizeof(float);
  std::uint64_t tiles = 1;
  grid.for_each_block([&](const GridBlock& block) { tiles += block.coded() ? 0 : 1; });
  return 2 * tiles * sizeof(float);  // twice, because a vector doubles when it grows
}

std::uint64_t macrocell_bytes(const NvdbGrid& grid) {
  const NodeLattice cells =
      has_macrocells(grid) ? grid.macrocells().lattice : make_lattice(grid.index_bbox(), kMacrocell);
  return static_cast<std::uint64_t>(cells.size()) * MacrocellGrid::kCellBytes;
}

std::uint64_t decoded_bytes(const PackedData& packed) {
  const std::vector<std::uint64_t> blocks = coded_blocks(packed);
  return std::accumulate(blocks.begin(), blocks.end(), std::uint64_t{0}) * nvdb::kFloatLeafBytes;
}

[[noreturn]] void fail_too_small(std::uint64_t needed, const VoxelMemory& memory) {
  if (memory.levels) needed += needed / 7 + 1;
  const std::string series =
      memory.volumes > 1 ? cat(", ", memory.volumes, " volumes of a series being held at a time") : std::string();
  throw Error(ErrorKind::usage,
              compose(option("memory", format_bytes(*memory.ceiling)),
                      " is too small to render this grid, which takes ", format_bytes(needed), " at least", series,
                      "; give ", option("memory", cat((memory.volumes * needed >> 20U) + 1, "MiB")), " or more"));
}

[[noreturn]] void fail_not_available(std::uint64_t needed, std::uint64_t available) {
  throw Error(ErrorKind::input,
              compose("the grid takes ", format_bytes(needed), " of memory at least to render, where ",
                      format_bytes(available), " are available; convert a part of it with ", option("roi")));
}

}  // namespace

VoxelPlan plan_voxels(const NvdbGrid& grid, const VoxelMemory& memory) {
  VoxelPlan plan;
  std::uint64_t available = available_bytes();
  std::uint64_t share = memory.ceiling.value_or(std::numeric_limits<std::uint64_t>::max()) / memory.volumes;
  if (memory.levels) {
    plan.level_bytes = std::min(share, available / memory.volumes) / 8;
    share -= memory.ceiling ? plan.level_bytes : 0;
    available -= plan.level_bytes;
  }
  if (grid.packed() == nullptr && !memory.ceiling) return plan;
  const auto blocks = static_cast<std::uint64_t>(leaf_lattice(grid.index_bbox()).size());
  plan.fixed_bytes = blocks * sizeof(std::uint32_t) + tile_bytes(grid) + macrocell_bytes(grid);
  if (grid.packed() == nullptr) {
    if (plan.fixed_bytes > share) fail_too_small(plan.fixed_bytes, memory);
    return plan;
  }
  const std::uint64_t most = std::min(share, available);
  if (plan.fixed_bytes + blocks * nvdb::kFloatLeafBytes <= most) return plan;

  // Counted only if the number of positions does not decide already.
  plan.decoded_bytes = decoded_bytes(*grid.packed());
  if (plan.fixed_bytes + plan.decoded_bytes <= most) return plan;
  const std::uint64_t needed = plan.fixed_bytes + kLeastCacheBytes;
  if (needed > share) fail_too_small(needed, memory);
  if (needed > available) fail_not_available(needed, available);
  const std::uint64_t taken = share <= available ? share : available / (2 * memory.volumes);
  plan.cache_bytes = std::max(taken, needed) - plan.fixed_bytes;
  return plan;
}

}  // namespace weir
