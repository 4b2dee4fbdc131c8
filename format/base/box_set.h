// BoxSet holds the finished positions of a lattice as a few disjoint boxes: work that goes box by box in the order of a
// plan needs at most three, and another plan can ask what is left. coverage_of() tells how boxes in any order cover a
// box.
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
  /// Returns the number of positions in the set.
  std::int64_t size() const;
  const std::vector<Box>& boxes() const { return boxes_; }

  /// Adds `box`, which must have no position that is in the set already. A box that continues the last box is merged
  /// with it.
  void add(const Box& box);

  /// Returns the part of `box` that is not in the set, as disjoint boxes, lowest z first; empty if all of it is in the
  /// set.
  std::vector<Box> missing_from(const Box& box) const;

  friend bool operator==(const BoxSet&, const BoxSet&) = default;

 private:
  std::vector<Box> boxes_;
};

/// How boxes cover a box.
struct Coverage {
  /// Index of the first box that shares a position of `whole` with an earlier box; none if the boxes are disjoint.
  std::optional<std::size_t> repeated;
  /// If the boxes are disjoint: the part of `whole` that none of them covers, as disjoint boxes sorted by their lowest
  /// positions, z before y before x.
  std::vector<Box> missing;
};

/// Returns how `boxes`, in any order, cover `whole`. n boxes of a regular decomposition take O(n log n) steps.
Coverage coverage_of(const Box& whole, std::span<const Box> boxes);

}  // namespace weir
