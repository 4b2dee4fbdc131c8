// Finds which 128^3 regions of a volume hold more than one value, from the values that were read. A file has no node
// for a region with only one value, or for a region of which a scene shows nothing.
#pragma once

#include <cstdint>
#include <vector>

#include "format/base/index.h"
#include "format/leaf/bounds.h"

namespace weir {

/// Takes 9 bytes per region.
class VariedRegions {
 public:
  explicit VariedRegions(const Box& domain);

  /// Notes that values in the range `values` were read in the region that holds `voxel`.
  void add(const Index3& voxel, const MinMax& values);
  /// Notes that values were read in the region that holds `voxel`, but that the scene shows none of them.
  void add_hidden(const Index3& voxel);
  /// Returns the number of regions that vary. Assumes that regions without read values vary as often as the others.
  std::uint64_t count() const;

 private:
  std::size_t region_of(const Index3& voxel) const;

  NodeLattice regions_;
  std::vector<MinMax> ranges_;
  std::vector<std::uint8_t> seen_;  // 1 for each region in which values were read
};

}  // namespace weir
