// A grid as the tree of nodes that an OpenVDB file stores: the file's own tree, or for a packed grid a tree made from
// the packed data.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "format/base/index.h"
#include "format/layout/nanovdb_layout.h"
#include "format/nanovdb/nvdb_grid.h"

namespace weir {

template <std::size_t Bits>
using NodeMask = std::array<std::uint64_t, Bits / 64>;

/// Identifies a node: by its address in the file, or by its lowest voxel.
struct ExportNode {
  const std::byte* at = nullptr;
  Index3 origin;
};

/// The entries of an upper or lower node, x-major, z fastest.
template <std::size_t Entries>
struct InternalNode {
  NodeMask<Entries> children{};
  NodeMask<Entries> active{};
  std::vector<float> values = std::vector<float>(Entries);  ///< values of tiles; entries with a child have no meaning
};
using UpperNode = InternalNode<nvdb::kUpper.entries>;
using LowerNode = InternalNode<nvdb::kLower.entries>;

/// An entry of the root: an upper node or a tile.
struct ExportRoot {
  Index3 origin;
  bool child = false;
  ExportNode upper;
  bool active = false;  ///< of a tile only
  float value = 0;      ///< of a tile only
};

/// Thread-safe except for the constructor. All calls throw Error(input) for damaged leaves and packed data.
class ExportTree {
 public:
  virtual ~ExportTree() = default;
  virtual std::vector<ExportRoot> roots() const = 0;
  virtual void read_upper(const ExportNode& upper, UpperNode& node) const = 0;
  virtual void read_lower(const ExportNode& lower, LowerNode& node) const = 0;
  /// Returns the child at `entry` of a node; the node's mask must have a child there.
  virtual ExportNode lower_of(const ExportNode& upper, std::size_t entry) const = 0;
  virtual ExportNode leaf_of(const ExportNode& lower, std::size_t entry) const = 0;
  /// Returns the mask of active voxels, bit x<<6 | y<<3 | z.
  virtual NodeMask<kLeafVoxels> leaf_mask(const ExportNode& leaf) const = 0;
  /// Reads all 512 values, index x<<6 | y<<3 | z.
  virtual void read_leaf(const ExportNode& leaf, std::span<float, 512> values) const = 0;
  /// Returns an upper bound of the number of leaves, for progress.
  virtual std::uint64_t leaves() const = 0;
};

/// Makes the tree of `grid`, which is not packed and must outlive the tree.
std::unique_ptr<ExportTree> make_stored_export_tree(const NvdbGrid& grid);

}  // namespace weir
