// The source of a brick cache's voxels.
#pragma once

#include <cstdint>
#include <vector>

#include "gpu/cuda/bricks/page_table.h"

namespace weir {

/// All pointers are to memory of the machine that the cache works on. Calls run in the order of its work.
class BlockSource {
 public:
  virtual ~BlockSource() = default;

  virtual BlockLattice lattice() const = 0;
  /// Returns the entries of all regions, in host memory. A region that is one value together with the seven above it
  /// has this value; any other has a missing page.
  virtual std::vector<RegionEntry> regions() const = 0;
  /// Fills pages[i] for regions[i], i < count. An entry is either missing, or has the one value that its block and
  /// the seven above it share.
  virtual void fill_pages(const std::uint32_t* regions, const std::uint32_t* pages, std::uint32_t count,
                          const PageTable& table) = 0;
  /// Decodes blocks[i] into values[512 i] (x << 6 | y << 3 | z), i < count.
  virtual void decode(const BlockId* blocks, std::uint32_t count, float* values) = 0;
  /// Throws Error(input) if a decoded block is damaged. Waits for the decoding first.
  virtual void check() = 0;
};

}  // namespace weir
