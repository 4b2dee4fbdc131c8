// The inner levels of the tree over a domain, held in memory: one small record per 128^3 region (a lower node or one
// tile of the upper node) and per 4096^3 block (an upper node or one root tile). 10^12 voxels have 477,000 regions,
// 65 MB.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "compressor/leaf/certificate.h"
#include "compressor/leaf/fill.h"
#include "format/base/index.h"
#include "format/leaf/bounds.h"
#include "format/packed/block_constants.h"

namespace weir {

/// Sums over the finite values of an inner node's in-domain voxels.
struct TileSums {
  float mean = 0;  ///< rounded to float
  float min = 0;   ///< valid if finite > 0
  float max = 0;
  bool exact = false;         ///< one tile of the fill value reads every voxel bit for bit (Fill::exact)
  bool keeps_values = false;  ///< one tile of the fill value reads every finite value bit for bit
  bool valued = false;        ///< any voxel has a value, finite or not
  std::uint64_t finite = 0;
  std::uint64_t zeros = 0;
  double residual = 0;  ///< sum of (value - mean)
  double sse = 0;       ///< sum of (value - mean)^2

  /// Returns the number of zeros that are lost if every voxel reads `fill`.
  std::uint64_t zeros_lost_to(float fill) const { return fill == 0 ? 0 : zeros; }
  /// Returns the sum of (value - fill)^2.
  double sse_about(float fill) const;
  double max_abs_about(float fill) const;
};

/// Returns the value of the tile that replaces all voxels of `sums`.
inline float tile_value(const Fill& fill, const TileSums& sums) {
  return fill.mode == FillMode::background || sums.finite == 0 ? fill.background : sums.mean;
}

/// Calls visit(position) for the lattice positions of a box in NanoVDB's order: x slowest, z fastest. NanoVDB sorts
/// nodes and the entries of their tables in this order.
template <typename Visit>
void for_each_in_file_order(const Box& box, const Visit& visit) {
  for (std::int64_t x = box.lo.x; x < box.hi.x; ++x) {
    for (std::int64_t y = box.lo.y; y < box.hi.y; ++y) {
      for (std::int64_t z = box.lo.z; z < box.hi.z; ++z) visit(Index3{x, y, z});
    }
  }
}

/// Returns whether all leaves of a box of lattice positions lie entirely in the domain.
inline bool are_whole(const NodeLattice& leaves, const Box& leaf_box) {
  const Index3 last = leaf_box.hi - Index3{1, 1, 1};
  return leaves.voxels(leaf_box.lo) == leaves.node_box(leaf_box.lo) && leaves.voxels(last) == leaves.node_box(last);
}

/// Returns whether a leaf is the first or the last leaf of a volume. By these two, other readers find the domain as the
/// bounding box, so every file but a packed one without a preview keeps them.
inline bool is_corner(const NodeLattice& leaves, const Index3& leaf) {
  return leaf == Index3{0, 0, 0} || leaf == leaves.count - Index3{1, 1, 1};
}

struct Region {
  TileSums sums;
  double key = 0;                ///< error saved per byte by opening the region; +inf if it must be open
  double tile_error = 0;         ///< squared error as one tile, weighted if a scene weighs
  double opening_gain = 0;       ///< the part of `tile_error` that its leaves' tiles save
  MinMax reach = kNoBounds;      ///< over the reaches of its leaves; set if a scene weighs
  bool open = false;             ///< a lower node; otherwise one tile of the upper node
  std::uint32_t leaves = 0;      ///< kept ones
  std::uint64_t node = 0;        ///< ordinal of the lower node in the file
  std::uint64_t first_leaf = 0;  ///< ordinal of its first kept leaf in the file
  std::uint64_t first_byte = 0;  ///< of that leaf, from the first leaf of the file
  std::uint32_t leaf_bytes = 0;  ///< of its kept leaves; for a packed region, of its chunk
  float packed_value = 0;        ///< for a packed file: the value of its blocks without a stream
  MeanRange packed_means;        ///< for a packed file: the range of the means of blocks that are not uniform
  double squared_error = 0;      ///< of the finite voxels that read a tile
};

struct Upper {
  TileSums sums;
  double key = 0;
  double tile_error = 0;    ///< squared error as one tile, weighted if a scene weighs
  double opening_gain = 0;  ///< the part of `tile_error` that its regions' tiles save
  bool open = false;        ///< an upper node; otherwise one root tile
  std::uint64_t node = 0;   ///< ordinal of the upper node in the file
};

struct TreeRegions {
  NodeLattice leaves;
  NodeLattice region_lattice;
  NodeLattice upper_lattice;
  std::vector<Region> regions;  ///< x fastest
  std::vector<Upper> uppers;    ///< x fastest

  explicit TreeRegions(const Box& domain);

  /// Returns the lattice positions of the leaves of `region`.
  Box leaf_box(std::int64_t region) const;
  /// Returns the position of a leaf in the masks of its lower node: x<<8 | y<<4 | z.
  std::size_t mask_position(const Index3& leaf) const {
    static_assert(kLowerLeaves == 16);
    const Index3 node = leaves.first + leaf;
    return static_cast<std::size_t>((node.x & 15) << 8 | (node.y & 15) << 4 | (node.z & 15));
  }
  /// Returns the linear index of the upper node above `region`.
  std::int64_t upper_of(std::int64_t region) const;
  /// Returns the position of a region in its upper node's table.
  Index3 entry_of(std::int64_t region) const;

  /// Calls visit(upper index) in file order: by x, then y, then z.
  template <typename Visit>
  void for_each_upper(Visit&& visit) const {
    for_each_in_file_order({{0, 0, 0}, upper_lattice.count},
                           [&](const Index3& at) { visit(upper_lattice.linear(at)); });
  }
  /// Calls visit(region index) for the regions of one upper node in file order.
  template <typename Visit>
  void for_each_region_of(std::int64_t upper, Visit&& visit) const {
    for_each_in_file_order(region_box(upper), [&](const Index3& at) { visit(region_lattice.linear(at)); });
  }

 private:
  Box region_box(std::int64_t upper) const;
};

/// Builds the sums of several parts (leaves or regions), added in a fixed order. There are two passes: all parts must
/// be added to the mean before the first part is added to the squares.
class TileSumsBuilder {
 public:
  /// Adds a part of `finite` values with this mean, sum of deviations from the mean, and extrema.
  void add_mean(std::uint64_t finite, double mean, double residual, float min, float max);
  void close_mean(float fallback);
  void add_squares(std::uint64_t finite, double mean, double residual, double sse);

  TileSums sums;

 private:
  CompensatedSum sum_;
};

}  // namespace weir
