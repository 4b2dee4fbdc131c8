// Which 128^3 regions of a volume hold more than one value, as far as values of them are seen: where they hold one, or
// a scene shows nothing of them, no file has a node for them.
#pragma once

#include <cstdint>
#include <vector>

#include "format/base/index.h"
#include "format/leaf/bounds.h"

namespace weir {

/// 9 bytes a region.
class VariedRegions {
 public:
  explicit VariedRegions(const Box& domain);

  /// Values within `values` (smallest, largest) were seen in the region that holds `voxel`.
  void add(const Index3& voxel, const MinMax& values);
  /// Values were seen there of which the scene shows none.
  void add_hidden(const Index3& voxel);
  /// Regions of which nothing was seen are taken to vary as often as the others.
  std::uint64_t count() const;

 private:
  std::size_t region_of(const Index3& voxel) const;

  NodeLattice regions_;
  std::vector<MinMax> ranges_;
  std::vector<std::uint8_t> seen_;  // whether there are any values of it
};

}  // namespace weir
