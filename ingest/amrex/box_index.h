// Finds the boxes of a level that touch a given box, with a tree of bounds over all boxes.
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
  /// Builds the index over `boxes`, fewer than 2^32, which must stay at their place in memory.
  explicit BoxIndex(std::span<const CellBox> boxes);

  /// Appends the positions of all boxes that share cells with `box` to `found`, in no order. Returns the number of
  /// tree nodes that it visited, which is its cost.
  std::size_t find(const Box& box, std::vector<std::uint32_t>& found) const;

  /// Returns the positions of two boxes that share cells; the same position twice if no boxes do. Throws
  /// Error(interrupted).
  std::pair<std::uint32_t, std::uint32_t> overlapping(Interruption interruption = nullptr) const;

 private:
  static constexpr std::size_t kLeafBoxes = 8;

  /// The bounds of a subtree and the axis along which it is halved: the axis along which its boxes lie in most
  /// layers. The number of layers is the spread of the boxes' centres in mean lengths of a box. Boxes as long as the
  /// bounds make one layer, however long they are: halves along their axis would both have the same bounds.
  struct Node {
    CellBox bounds;
    std::size_t axis = 0;
  };

  Node look_at(std::size_t begin, std::size_t end) const;
  void build(std::size_t node, std::size_t begin, std::size_t end);
  std::size_t find(std::size_t node, std::size_t begin, std::size_t end, const Box& box,
                   std::vector<std::uint32_t>& found) const;

  std::span<const CellBox> boxes_;
  std::vector<std::uint32_t> order_;  ///< positions of boxes; those of a subtree are side by side
  std::vector<CellBox> bounds_;       ///< of the subtrees: the halves of node n are nodes 2n + 1 and 2n + 2
};

}  // namespace weir
