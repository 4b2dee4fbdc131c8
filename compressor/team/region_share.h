// How several processes share one volume: each gets a run of 128^3 regions in the order of their index. No leaf belongs
// to two processes.
#pragma once

#include <vector>

#include "compressor/team/team.h"
#include "format/base/index.h"

namespace weir {

/// Returns positions [run.begin, run.end) of a lattice of `count`, x fastest, as at most five boxes in that order.
std::vector<Box> boxes_of_run(const Index3& count, const Share& run);

/// Returns this rank's positions of the region lattice.
std::vector<Box> own_regions(const NodeLattice& regions, const Team& team);

/// This rank's positions of the leaf lattice: the leaves of own_regions().
class OwnLeaves {
 public:
  OwnLeaves(const NodeLattice& leaves, const Team& team);
  /// Returns the parts of `box` that belong to this rank.
  std::vector<Box> of(const Box& box) const;

 private:
  std::vector<Box> boxes_;
};

}  // namespace weir
