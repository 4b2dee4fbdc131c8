// The positions of a lattice that are done, as a few disjoint boxes: work that goes box by box in the order of a plan
// fills three of them at most, and another plan can ask what is left.
#pragma once

#include <cstdint>
#include <vector>

#include "format/base/index.h"

namespace weir {

class BoxSet {
 public:
  bool empty() const { return boxes_.empty(); }
  /// Positions in it.
  std::int64_t size() const;
  const std::vector<Box>& boxes() const { return boxes_; }

  /// `box` must have no position that is there already. One that continues the last box becomes part of it.
  void add(const Box& box);

  /// What of `box` is not in the set: disjoint boxes, lowest z first; none where all of it is.
  std::vector<Box> missing_from(const Box& box) const;

  friend bool operator==(const BoxSet&, const BoxSet&) = default;

 private:
  std::vector<Box> boxes_;
};

}  // namespace weir
