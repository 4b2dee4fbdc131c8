// A grid on one device as bricks, with all that rendering needs there. For grids that are packed, or too large for
// the device.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "gpu/cuda/bricks/brick_cache.h"
#include "gpu/cuda/bricks/device_pyramid.h"
#include "gpu/cuda/volume/device_macrocells.h"
#include "gpu/cuda/volume/device_table.h"
#include "gpu/cuda/volume/grid_bytes.h"

namespace weir {

/// Must be made and used with its device current.
class BrickVolume {
 public:
  /// `bytes` are the bytes of `grid`, on the device or in host memory that it reads. `grid` must outlive the object.
  /// `cells` are the bounds of macrocells. `budget.taken` is ignored: the constructor finds it. Levels of detail take
  /// at most `budget.levels` bytes. Throws the errors of BrickCache, BlockDecoder and DeviceTable.
  BrickVolume(const NvdbGrid& grid, GridBytes bytes, const std::vector<MinMax>& cells, BrickBudget budget);

  const GridBytes& bytes() const { return bytes_; }
  GridBytes take_bytes() && { return std::move(bytes_); }
  BrickCache& cache() { return *cache_; }
  /// Gives device memory back for a picture whose allocation was refused for the reason `why`, as BrickCache::shrink
  /// does.
  bool shrink(std::uint64_t bytes, const std::string& why);
  DeviceMacrocells& cells() { return cells_; }
  /// Returns the finest level of detail from `wanted` on that there is room for; 0: none.
  int finest_level(int wanted) const;
  /// Returns the levels from `finest` on. They are kept for the next call with the same `finest`.
  const DevicePyramid& levels(int finest);
  /// Returns macrocells for a picture with levels from `finest` on, or for a draft of it. `cells` is the lattice of
  /// the cells whose bounds the constructor was given.
  DeviceMacrocells levelled_cells(int finest, const CellLattice& cells, const LevelChoice& choice, bool draft);

 private:
  GridBytes bytes_;
  std::variant<std::monostate, DeviceTable<FloatBlock>, DeviceTable<QuantisedBlock>> table_;
  DeviceMacrocells cells_;
  std::optional<BrickCache> cache_;
  std::uint64_t level_bytes_ = 0;
  std::optional<DevicePyramid> levels_;
};

}  // namespace weir
