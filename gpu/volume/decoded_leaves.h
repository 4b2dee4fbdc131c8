// The coded blocks of a packed grid as float leaves in memory. The leaf table points to them if a file has no leaves
// of its own. Takes 2144 bytes per coded block.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <memory>
#include <vector>

#include "format/nanovdb/nvdb_grid.h"

namespace weir {

/// Returns the number of coded blocks of each region of `packed`, in the order of the region table. Counts on all
/// threads of the machine. Throws the errors of PackedData::stream.
std::vector<std::uint64_t> coded_blocks(const PackedData& packed);

class DecodedLeaves {
 public:
  /// Makes an object without leaves.
  DecodedLeaves() = default;
  /// Decodes all coded blocks of the packed `grid`, on all threads of the machine. Only the values of a leaf are set.
  /// Throws Error(input) if the leaves take more memory than is available, and the errors of NvdbGrid::for_each_block
  /// and decode_block.
  explicit DecodedLeaves(const NvdbGrid& grid);

  /// 32-byte aligned; null if there are no leaves.
  const std::byte* data() const { return leaves_.get(); }
  std::uint64_t count() const { return count_; }
  std::uint64_t bytes() const;

  /// Calls visit(block, number of its leaf) for every coded block of the grid that was decoded.
  void for_each(const NvdbGrid& grid, const std::function<void(const GridBlock&, std::uint64_t)>& visit) const;

 private:
  struct Free {
    void operator()(std::byte* p) const { std::free(p); }
  };

  void decode_region(const NvdbGrid& grid, std::int64_t region);

  std::unique_ptr<std::byte[], Free> leaves_;
  std::uint64_t count_ = 0;
  std::vector<std::uint64_t> first_;  ///< number of each region's first leaf
};

}  // namespace weir
