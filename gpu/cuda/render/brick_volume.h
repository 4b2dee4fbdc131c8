// A grid on one device as bricks, with all that rendering it needs there: packed, or too large for the device.
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

/// Made and used with its device current.
class BrickVolume {
 public:
  /// `bytes` are those of `grid`, which must outlive the object, on the device or in host memory that it reads; `cells`
  /// bounds of macrocells. Of `budget`, what is taken already is found here; of its `levels`, levels of detail are
  /// made. Throws as BrickCache, BlockDecoder and DeviceTable.
  BrickVolume(const NvdbGrid& grid, GridBytes bytes, const std::vector<MinMax>& cells, BrickBudget budget);

  const GridBytes& bytes() const { return bytes_; }
  GridBytes take_bytes() && { return std::move(bytes_); }
  BrickCache& cache() { return *cache_; }
  /// Gives device memory back that a picture was refused, for the reason `why`: as BrickCache::shrink.
  bool shrink(std::uint64_t bytes, const std::string& why);
  DeviceMacrocells& cells() { return cells_; }
  /// The finest level of detail from `wanted` on that there is room for; 0: none.
  int finest_level(int wanted) const;
  /// The levels from that one on; kept for the next call with the same.
  const DevicePyramid& levels(int finest);
  /// Macrocells for a picture with levels from `finest` on, or a draft of one; `cells` are those whose bounds the
  /// volume was made with.
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
