// Bounds of the values in cells of 16^3 or 32^3 voxels, read from the file if it has them, and the majorants of the
// extinction that a transfer function gives them. A cell's bounds hold for every filtered look-up in it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "format/nanovdb/nvdb_grid.h"
#include "gpu/math/dda.h"
#include "gpu/scene/transfer_function.h"

namespace weir {

/// Returns whether the file's own macrocells bound filtered look-ups.
bool has_macrocells(const NvdbGrid& grid);

/// Returns the cells in the form in which a tracer walks them.
CellLattice cell_lattice(const NodeLattice& lattice);

/// Returns whether it is a range of finite values: both ends are finite, and min <= max.
bool has_finite_ends(const MinMax& range);

class MacrocellGrid {
 public:
  /// Makes cells of at least `edge` voxels over grid.index_bbox(). The file's cells are merged, eight to one, until
  /// they are large enough. If the file has none (or none with an apron), the cells are gathered from all blocks.
  MacrocellGrid(const NvdbGrid& grid, std::int64_t edge);
  /// Uses given bounds; `cells` has lattice.size() entries.
  MacrocellGrid(const NodeLattice& lattice, std::vector<MinMax> cells);

  CellLattice lattice() const { return cell_lattice(lattice_); }
  const NodeLattice& nodes() const { return lattice_; }
  const std::vector<MinMax>& bounds() const { return cells_; }
  /// Returns the range from the least to the largest finite end; none if no cell has a finite end.
  std::optional<MinMax> finite_range() const;
  /// Returns the bytes of the bounds and, while a picture is made, of the majorants.
  std::uint64_t bytes() const { return cells_.size() * kCellBytes; }
  static constexpr std::uint64_t kCellBytes = sizeof(MinMax) + sizeof(float);
  /// Returns boxes (voxels, inside the domain) that contain all cells for which `shows` returns true; it is called
  /// with a position in `bounds`. There is one box per row in x, from the first to the last such cell. Returns the
  /// domain if there is no such cell.
  std::vector<Box> content(const std::function<bool(std::size_t)>& shows) const;
  /// Returns the largest opacity of each cell, in [0, 1].
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
