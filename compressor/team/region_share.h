// Which part of a volume is whose where several processes convert it: runs of
// 128^3 regions in the order of their index, so that none has a leaf in common
// with another.
#pragma once

#include <vector>

#include "compressor/team/team.h"
#include "format/base/index.h"

namespace weir {

/// Positions [run.begin, run.end) of a lattice of `count`, x fastest, as five boxes at most, in their order.
std::vector<Box> boxes_of_run(const Index3& count, const Share& run);

/// This rank's positions of the region lattice.
std::vector<Box> own_regions(const NodeLattice& regions, const Team& team);

/// This rank's positions of the leaf lattice: the leaves of its regions.
class OwnLeaves {
 public:
  OwnLeaves(const NodeLattice& leaves, const Team& team);
  /// What of `box` is its own.
  std::vector<Box> of(const Box& box) const;

 private:
  std::vector<Box> boxes_;
};

}  // namespace weir
