// Which of a level's boxes touch a box: a tree of bounds over all of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "format/base/index.h"
#include "ingest/amrex/cell_header.h"
#include "ingest/amrex/interruption.h"

namespace weir {

class BoxIndex {
 public:
  BoxIndex() = default;
  /// Of `boxes`, fewer than 2^32 of them, which must stay where they are.
  explicit BoxIndex(std::span<const CellBox> boxes);

  /// Adds the positions of all boxes that have cells in common with `box`, in no order. Returns how many nodes of the
  /// tree it looked at, which is what it cost.
  std::size_t find(const Box& box, std::vector<std::uint32_t>& found) const;

  /// Two boxes that have cells in common, by position; the same position twice where there are none. Throws
  /// Error(interrupted).
  std::pair<std::uint32_t, std::uint32_t> overlapping(Interruption interruption = nullptr) const;

 private:
  static constexpr std::size_t kLeafBoxes = 8;

  /// Of a subtree. It is halved along the axis along which its boxes lie in most layers: by how far their centres lie
  /// apart, counted in mean lengths of a box. Of boxes as long as their bounds there is one layer, however long these
  /// are: halves along them would both have the same bounds.
  struct Node {
    CellBox bounds;
    std::size_t axis = 0;
  };

  Node look_at(std::size_t begin, std::size_t end) const;
  void build(std::size_t node, std::size_t begin, std::size_t end);
  std::size_t find(std::size_t node, std::size_t begin, std::size_t end, const Box& box,
                   std::vector<std::uint32_t>& found) const;

  std::span<const CellBox> boxes_;
  std::vector<std::uint32_t> order_;  ///< boxes, those of a subtree side by side
  std::vector<CellBox> bounds_;       ///< of the subtrees: the first half of node n is 2n + 1, the second 2n + 2
};

}  // namespace weir
