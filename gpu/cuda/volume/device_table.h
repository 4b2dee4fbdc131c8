// The block table of a grid in device memory. It is built there, by one thread per block that walks the tree; a host
// would have to read the whole tree.
#pragma once

#include "format/nanovdb/nvdb_grid.h"
#include "gpu/cuda/runtime/device_array.h"
#include "gpu/cuda/volume/block_table.h"

namespace weir {

/// Block is FloatBlock for grids of float32 and QuantisedBlock for all others.
template <class Block>
class DeviceTable {
 public:
  /// `data` is the device's copy of grid.data() and must outlive the object. `grid`, which was validated, tells where
  /// its upper nodes are. Throws Error(input) if the domain has more than 2^31 blocks or leaves span more than 128
  /// GiB, Error(io) if the device has no room.
  DeviceTable(const NvdbGrid& grid, const std::byte* data);

  const BlockTable<Block>& view() const { return view_; }
  std::uint64_t bytes() const { return blocks_.bytes(); }

 private:
  DeviceArray<Block> blocks_;
  BlockTable<Block> view_;
};

}  // namespace weir
