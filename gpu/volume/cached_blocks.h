// The voxels of a packed grid that do not fit into memory when decoded: a table that marks the coded blocks, and a
// cache of decoded ones. A block that is not in the cache is decoded from the file when one of its voxels is looked
// up, to the same values as DecodedLeaves has. Host only.
//
//   CachedBlocks blocks(grid, bytes);                            // shared by all threads
//   BlockReader reader(blocks);                                  // one per thread
//   CachedSampler volume{{reader}, Filter::trilinear};           // used like VolumeSampler
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "format/nanovdb/nvdb_grid.h"
#include "gpu/volume/block_cache.h"
#include "gpu/volume/leaf_table.h"
#include "gpu/volume/volume_sampler.h"

namespace weir {

class CachedBlocks {
 public:
  /// Covers grid.index_bbox(). `grid` must be packed and outlive the object. The cache takes `cache_bytes`. Throws
  /// the errors of LeafTable.
  CachedBlocks(const NvdbGrid& grid, std::uint64_t cache_bytes);

  LeafTableView table() const { return table_.view(); }
  /// Reads the values of the block at the table's position `at`, without the cache. Returns true if the block has one
  /// value; then only values[0] is set. Throws Error(input) if its stream or directory is damaged.
  bool read(const Int3& at, std::span<float, kLeafVoxels> values) const;
  std::uint64_t bytes() const { return table_.bytes() + cache_.bytes(); }  ///< of table, tile values and cache

 private:
  friend class BlockReader;

  // Decodes the 512 values of the block at the table's position `at` from the file.
  void decode(const Int3& at, std::span<float, kLeafVoxels> values) const;

  const PackedData* packed_;
  Index3 first_;  ///< block at the table's first position
  LeafTable table_;
  BlockCache cache_;
};

/// Counts of the look-ups in coded blocks.
struct CacheCounts {
  std::uint64_t lookups = 0;  ///< one for each block that a sample needs voxels of
  std::uint64_t decoded = 0;  ///< blocks that were not in the cache
  std::uint64_t evicted = 0;  ///< blocks that were evicted

  CacheCounts& operator+=(const CacheCounts& other) {
    lookups += other.lookups;
    decoded += other.decoded;
    evicted += other.evicted;
    return *this;
  }
};

/// One thread's access to CachedBlocks, which must outlive it.
class alignas(64) BlockReader {
 public:
  explicit BlockReader(CachedBlocks& blocks) : blocks_(&blocks) {}

  /// Reads the values at `offsets` of the coded block at the table's position `at`; its entry has the number `key`.
  /// Throws Error(input) if its stream or directory is damaged.
  template <std::size_t N>
  void load(const Int3& at, std::uint32_t key, const std::array<std::uint32_t, N>& offsets, float (&values)[N]) {
    ++counts_.lookups;
    if (blocks_->cache_.load(key, offsets, values)) return;
    decode(at, key);
    for (std::size_t k = 0; k < N; ++k) values[k] = decoded_[offsets[k]];
  }

  LeafTableView table() const { return blocks_->table(); }
  const CacheCounts& counts() const { return counts_; }

 private:
  void decode(const Int3& at, std::uint32_t key);

  CachedBlocks* blocks_;
  CacheCounts counts_;
  std::array<float, kLeafVoxels> decoded_{};  ///< the block that was decoded last
};

/// Replaces LeafTableView in a FilteredVolume, with the same values.
struct CachedTableView {
  LeafTableView table;
  Int3 extent;
  BlockReader* reader = nullptr;

  CachedTableView() = default;
  CachedTableView(BlockReader& blocks) : table(blocks.table()), extent(table.extent), reader(&blocks) {}

  /// As the functions of LeafTableView.
  float voxel(const Int3& i) const {
    const Int3 v = table.from_corner(i);
    float value[1];
    load<1>(v, {LeafTableView::offset_in_leaf(v)}, value);
    return value[0];
  }
  bool taps(const Int3& i, float (&c)[8]) const {
    const Int3 v = table.from_corner(i);
    if (table.taps_in_one_block(i, v)) {
      const std::uint32_t o = LeafTableView::offset_in_leaf(v);
      return !load<8>(v, {o, o + 64, o + 8, o + 72, o + 1, o + 65, o + 9, o + 73}, c);
    }
    for (int k = 0; k < 8; ++k) {
      c[k] = voxel(
          {upper(i.x, (k & 1) != 0, extent.x), upper(i.y, (k & 2) != 0, extent.y), upper(i.z, (k & 4) != 0, extent.z)});
    }
    return false;
  }

 private:
  // Reads the values at `offsets` of the block that covers `v`. Returns false if the block is a tile; then only
  // values[0] is set.
  template <std::size_t N>
  bool load(const Int3& v, const std::array<std::uint32_t, N>& offsets, float (&values)[N]) const {
    const Int3 at{v.x >> 3, v.y >> 3, v.z >> 3};
    const std::uint32_t key = table_index(at, table.count);
    const std::uint32_t entry = table.entries[key];
    if (entry < table.tile_count) {
      values[0] = table.tile_values[entry];
      return false;
    }
    reader->load(at, key, offsets, values);
    return true;
  }
};

using CachedSampler = FilteredVolume<CachedTableView>;

}  // namespace weir
