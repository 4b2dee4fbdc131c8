// The coded blocks of a packed grid as float leaves in memory: what the leaf table points to where a file has no
// leaves of its own. Takes 2144 bytes for each coded block.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <memory>
#include <vector>

#include "format/nanovdb/nvdb_grid.h"

namespace weir {

/// How many coded blocks each region of `packed` has, in the order of the region table; counted on all threads of the
/// machine. Throws as PackedData::stream.
std::vector<std::uint64_t> coded_blocks(const PackedData& packed);

class DecodedLeaves {
 public:
  /// None.
  DecodedLeaves() = default;
  /// Decodes all coded blocks of `grid`, which is packed, on all threads of the machine. Of a leaf only its values
  /// are set. Throws Error(input) where they take more than the memory that is available, and as
  /// NvdbGrid::for_each_block and decode_block.
  explicit DecodedLeaves(const NvdbGrid& grid);

  /// 32-byte aligned; null where there is none.
  const std::byte* data() const { return leaves_.get(); }
  std::uint64_t count() const { return count_; }
  std::uint64_t bytes() const;

  /// Calls visit(block, number of its leaf) for every coded block of that grid.
  void for_each(const NvdbGrid& grid, const std::function<void(const GridBlock&, std::uint64_t)>& visit) const;

 private:
  struct Free {
    void operator()(std::byte* p) const { std::free(p); }
  };

  void decode_region(const NvdbGrid& grid, std::int64_t region);

  std::unique_ptr<std::byte[], Free> leaves_;
  std::uint64_t count_ = 0;
  std::vector<std::uint64_t> first_;  ///< number of the first leaf of each region
};

}  // namespace weir
