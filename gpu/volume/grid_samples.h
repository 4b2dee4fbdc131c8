// Filtered values of a grid at any positions, for callers with many look-ups. Packed blocks are decoded at once into
// a table. If they would take too much memory, they are decoded when they are looked up. Host only.
#pragma once

#include <cstdint>
#include <memory>
#include <numeric>
#include <optional>
#include <vector>

#include "format/layout/nanovdb_layout.h"
#include "format/nanovdb/nvdb_grid.h"
#include "gpu/volume/cached_blocks.h"
#include "gpu/volume/decoded_leaves.h"
#include "gpu/volume/leaf_table.h"
#include "gpu/volume/volume_sampler.h"

namespace weir {

/// Thread-safe.
class GridSamples {
 public:
  /// Most bytes of blocks that are decoded at once. It is also the size of the cache for grids that have more.
  static constexpr std::uint64_t kMostDecoded = std::uint64_t{256} << 20U;

  /// `grid` must outlive the object. Throws the errors of LeafTable.
  explicit GridSamples(const NvdbGrid& grid, std::uint64_t most_decoded = kMostDecoded) {
    if (decoded_bytes(grid) > most_decoded) {
      cached_ = std::make_unique<CachedBlocks>(grid, most_decoded);
    } else {
      table_.emplace(grid);
    }
  }

  /// Calls use(volume) with a FilteredVolume for the calling thread. A look-up throws Error(input) if a packed block
  /// is damaged.
  template <class Use>
  void with_volume(Filter filter, const Use& use) {
    if (table_) return use(VolumeSampler{table_->view(), filter});
    BlockReader reader(*cached_);
    use(CachedSampler{{reader}, filter});
  }

  /// Returns the bytes of the table and of the decoded blocks or their cache.
  std::uint64_t bytes() const { return table_ ? table_->bytes() : cached_->bytes(); }

 private:
  static std::uint64_t decoded_bytes(const NvdbGrid& grid) {
    if (grid.packed() == nullptr) return 0;
    const std::vector<std::uint64_t> blocks = coded_blocks(*grid.packed());
    return std::accumulate(blocks.begin(), blocks.end(), std::uint64_t{0}) * nvdb::kFloatLeafBytes;
  }

  std::optional<LeafTable> table_;
  std::unique_ptr<CachedBlocks> cached_;  // set if there is no table
};

}  // namespace weir
