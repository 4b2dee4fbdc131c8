// Where the voxels of a brick cache come from.
#pragma once

#include <cstdint>
#include <vector>

#include "gpu/cuda/bricks/page_table.h"

namespace weir {

/// All pointers are to memory of the machine that the cache works on; calls are in the order of its work.
class BlockSource {
 public:
  virtual ~BlockSource() = default;

  virtual BlockLattice lattice() const = 0;
  /// Of all regions (host memory): those that are one value together with the seven above them, and missing pages.
  virtual std::vector<RegionEntry> regions() const = 0;
  /// Fills pages[i] for regions[i], i < count: an entry is missing, or has the one value of its block and the seven
  /// above it.
  virtual void fill_pages(const std::uint32_t* regions, const std::uint32_t* pages, std::uint32_t count,
                          const PageTable& table) = 0;
  /// Decodes blocks[i] into values[512 i] (x << 6 | y << 3 | z), i < count.
  virtual void decode(const BlockId* blocks, std::uint32_t count, float* values) = 0;
  /// Throws Error(input) where something that was decoded is damaged; waits for it.
  virtual void check() = 0;
};

}  // namespace weir
