#include "format/nanovdb/nvdb_checksum.h"

#include "format/layout/nanovdb_layout.h"
#include "format/nanovdb/grid_head.h"

namespace weir {
namespace {

// Up to this version the checksum of the head covers the root table.
constexpr std::uint32_t kLastVersionWithRootTable = 32U << 21U | 6U << 10U;

}  // namespace

std::uint32_t computed_head_checksum(const NvdbGrid& grid) {
  const bool with_table = grid.version() <= kLastVersionWithRootTable;
  return head_checksum(grid.data().first(with_table ? nvdb::kRootTilesOffset + grid.root_tiles() * nvdb::kRootTileBytes
                                                    : nvdb::kRootOffset));
}

}  // namespace weir
