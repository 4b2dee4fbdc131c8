// Bounds of the values in cells of 16^3 or 32^3 voxels, from the file where it
// has them, and the majorants of the extinction that follow from them through a
// transfer function. A cell's bounds hold for every filtered lookup in it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "format/nanovdb/nvdb_grid.h"
#include "gpu/math/dda.h"
#include "gpu/scene/transfer_function.h"

namespace weir {

/// Whether a file's own macrocells bound filtered lookups.
bool has_macrocells(const NvdbGrid& grid);

/// Cells as a tracer walks them.
CellLattice cell_lattice(const NodeLattice& lattice);

/// Whether it is a range of finite values.
bool has_finite_ends(const MinMax& range);

class MacrocellGrid {
 public:
  /// Cells of at least `edge` voxels over grid.index_bbox(): the file's, merged eight to one until
  /// they are that large, or, where it has none (or without an apron), gathered from all blocks.
  MacrocellGrid(const NvdbGrid& grid, std::int64_t edge);
  /// Given bounds; `cells` has lattice.size() entries.
  MacrocellGrid(const NodeLattice& lattice, std::vector<MinMax> cells);

  CellLattice lattice() const { return cell_lattice(lattice_); }
  const NodeLattice& nodes() const { return lattice_; }
  const std::vector<MinMax>& bounds() const { return cells_; }
  /// From the least to the largest end that is finite; none where no cell has one.
  std::optional<MinMax> finite_range() const;
  /// Of bounds and, while a picture is made, majorants.
  std::uint64_t bytes() const { return cells_.size() * kCellBytes; }
  static constexpr std::uint64_t kCellBytes = sizeof(MinMax) + sizeof(float);
  /// Boxes (voxels, inside the domain) that hold all cells `shows` is true for, called with a position in
  /// `bounds`: one from the first to the last of each row in x. The domain where there is no such cell.
  std::vector<Box> content(const std::function<bool(std::size_t)>& shows) const;
  /// Largest opacity of each cell, in [0, 1].
  std::vector<float> majorants(const TransferFunction& transfer) const;

 private:
  void merge();
  void gather(const NvdbGrid& grid);
  void gather_coded(const NvdbGrid& grid, const GridBlock& block);
  void gather_absent(const NvdbGrid& grid);
  void gather_tile(const GridBlock& block);
  void include(const Index3& cell, float low, float high);

  NodeLattice lattice_;
  std::vector<MinMax> cells_;
};

}  // namespace weir
