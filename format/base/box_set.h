// The positions of a lattice that are done, as a few disjoint boxes: work that goes box by box in the order of a plan
// fills three of them at most, and another plan can ask what is left. And how boxes that come in any order cover a box.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
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

/// How boxes cover a box.
struct Coverage {
  /// Index of the first box that has a position of `whole` which a box before it has; none where they are disjoint.
  std::optional<std::size_t> repeated;
  /// Where they are disjoint: what of `whole` none of them has, as disjoint boxes by their lowest positions, z before y
  /// before x.
  std::vector<Box> missing;
};

/// How `boxes`, in any order, cover `whole`. n boxes of a regular decomposition take O(n log n) steps.
Coverage coverage_of(const Box& whole, std::span<const Box> boxes);

}  // namespace weir
