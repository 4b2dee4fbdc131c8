#include "gpu/volume/cached_blocks.h"

#include "format/nanovdb/packed_blocks.h"

namespace weir {

CachedBlocks::CachedBlocks(const NvdbGrid& grid, std::uint64_t cache_bytes)
    : packed_(grid.packed()),
      first_(floor_div(grid.index_bbox().lo, kLeafDim)),
      table_(grid, CodedBlocks::marked),
      cache_(cache_bytes) {}

// Looks at the directory again each time. This takes about 50 ns, and decoding a stream takes microseconds. Keeping
// the place of each block's stream would take more memory than the table.
void CachedBlocks::decode(const Int3& at, std::span<float, kLeafVoxels> values) const {
  const Index3 block = first_ + Index3{at.x, at.y, at.z};
  const PackedRegion region = packed_->region(floor_div(block, kLowerLeaves) - packed_->regions().first);
  packed_->decode(packed_->stream(region, packed_position(block)), values);
}

bool CachedBlocks::read(const Int3& at, std::span<float, kLeafVoxels> values) const {
  const LeafTableView table = table_.view();
  const std::uint32_t entry = table.entries[table_index(at, table.count)];
  if (entry >= table.tile_count) {
    decode(at, values);
    return false;
  }
  values[0] = table.tile_values[entry];
  return true;
}

void BlockReader::decode(const Int3& at, std::uint32_t key) {
  blocks_->decode(at, decoded_);
  const auto turn = static_cast<std::uint32_t>(counts_.decoded++);
  if (blocks_->cache_.store(key, decoded_, turn)) ++counts_.evicted;
}

}  // namespace weir
