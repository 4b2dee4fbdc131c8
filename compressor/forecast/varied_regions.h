// Which 128^3 regions of a volume hold more than one value, as far as values of them are seen: where they hold one, no
// file has a node for them.
#pragma once

#include <cstdint>
#include <vector>

#include "format/base/index.h"
#include "format/nanovdb/nvdb_grid.h"

namespace weir {

/// 8 bytes a region.
class VariedRegions {
 public:
  explicit VariedRegions(const Box& domain);

  /// Values within `values` (smallest, largest) were seen in the region that holds `voxel`.
  void add(const Index3& voxel, const MinMax& values);
  /// Regions of which nothing was seen are taken to vary as often as the others.
  std::uint64_t count() const;

 private:
  NodeLattice regions_;
  std::vector<MinMax> ranges_;
};

}  // namespace weir
