#include "gpu/volume/macrocell_grid.h"

#include <algorithm>
#include <array>

#include "format/nanovdb/macrocells.h"
#include "gpu/math/narrow.h"

namespace weir {

namespace {

// Bounds of no values. Any value widens them, and max_opacity treats them as unknown.
constexpr MinMax kNoValues{kInfinity, -kInfinity};

// Returns the cells that a box of voxels touches.
Box cells_of(const Box& voxels, std::int64_t edge) {
  return {floor_div(voxels.lo, edge), floor_div(voxels.hi - Index3{1, 1, 1}, edge) + Index3{1, 1, 1}};
}

}  // namespace

bool has_finite_ends(const MinMax& range) {
  return is_finite(range.min) && is_finite(range.max) && range.min <= range.max;
}

bool has_macrocells(const NvdbGrid& grid) {
  const MacrocellView file = grid.macrocells();
  return !file.cells.empty() && file.apron >= 1;
}

CellLattice cell_lattice(const NodeLattice& lattice) {
  return {.count = narrow(lattice.count),
          .shift = narrow(lattice.domain.lo - lattice.first * lattice.dim),
          .edge = static_cast<float>(lattice.dim)};
}

MacrocellGrid::MacrocellGrid(const NvdbGrid& grid, std::int64_t edge) {
  if (has_macrocells(grid)) {
    const MacrocellView file = grid.macrocells();
    lattice_ = file.lattice;
    cells_.assign(file.cells.begin(), file.cells.end());
  } else {
    lattice_ = make_lattice(grid.index_bbox(), kMacrocell);
    cells_.assign(static_cast<std::size_t>(lattice_.size()), kNoValues);
    gather(grid);
  }
  while (lattice_.dim < edge) merge();
}

MacrocellGrid::MacrocellGrid(const NodeLattice& lattice, std::vector<MinMax> cells)
    : lattice_(lattice), cells_(std::move(cells)) {}

std::optional<MinMax> MacrocellGrid::finite_range() const {
  MinMax range = kNoValues;
  for (const MinMax& cell : cells_) {
    if (is_finite(cell.min)) range.min = std::min(range.min, cell.min);
    if (is_finite(cell.max)) range.max = std::max(range.max, cell.max);
  }
  return has_finite_ends(range) ? std::optional(range) : std::nullopt;
}

std::vector<float> MacrocellGrid::majorants(const TransferFunction& transfer) const {
  std::vector<float> result(cells_.size());
  for (std::size_t i = 0; i < cells_.size(); ++i) result[i] = transfer.max_opacity(cells_[i].min, cells_[i].max);
  return result;
}

std::vector<Box> MacrocellGrid::content(const std::function<bool(std::size_t)>& shows) const {
  std::vector<Box> boxes;
  for (std::int64_t row = 0; row < lattice_.size(); row += lattice_.count.x) {
    std::int64_t first = row;
    std::int64_t last = row + lattice_.count.x - 1;
    while (first <= last && !shows(static_cast<std::size_t>(first))) ++first;
    while (last > first && !shows(static_cast<std::size_t>(last))) --last;
    if (first > last) continue;
    boxes.push_back({lattice_.voxels(lattice_.position(first)).lo, lattice_.voxels(lattice_.position(last)).hi});
  }
  if (boxes.empty()) boxes.push_back(lattice_.domain);
  return boxes;
}

void MacrocellGrid::include(const Index3& cell, float low, float high) {
  MinMax& bounds = cells_[static_cast<std::size_t>(lattice_.linear(cell - lattice_.first))];
  // NaN bounds, in the file or here, are unknown and stay so.
  bounds.min = low < bounds.min || low != low ? low : bounds.min;
  bounds.max = high > bounds.max || high != high ? high : bounds.max;
}

void MacrocellGrid::merge() {
  const NodeLattice fine = lattice_;
  const std::vector<MinMax> bounds = std::move(cells_);
  lattice_ = make_lattice(fine.domain, 2 * fine.dim);
  cells_.assign(static_cast<std::size_t>(lattice_.size()), kNoValues);
  for_each_index({fine.first, fine.first + fine.count}, [&](const Index3& cell) {
    const MinMax& b = bounds[static_cast<std::size_t>(fine.linear(cell - fine.first))];
    include(floor_div(cell, 2), b.min, b.max);
  });
}

void MacrocellGrid::gather(const NvdbGrid& grid) {
  grid.for_each_block([&](const GridBlock& block) {
    if (block.coded()) {
      gather_coded(grid, block);
    } else {
      gather_tile(block);
    }
  });
  if (grid.packed() == nullptr) gather_absent(grid);  // a packed grid has all of its regions
}

// for_each_block visits no absent root entry. Its voxels are all background.
void MacrocellGrid::gather_absent(const NvdbGrid& grid) {
  const NodeLattice roots = make_lattice(lattice_.domain, kUpperDim);
  const Box all{roots.first, roots.first + roots.count};
  std::vector<bool> there(static_cast<std::size_t>(roots.size()));
  grid.for_each_root_entry([&](const RootEntry& entry) {
    const Index3 root = floor_div(entry.origin, kUpperDim);
    if (all.contains(root)) there[static_cast<std::size_t>(roots.linear(root - roots.first))] = true;
  });
  for (std::int64_t i = 0; i < roots.size(); ++i) {
    if (there[static_cast<std::size_t>(i)]) continue;
    const Index3 origin = (roots.first + roots.position(i)) * kUpperDim;
    gather_tile({origin, kUpperDim, false, grid.background(), nullptr});
  }
}

void MacrocellGrid::gather_tile(const GridBlock& block) {
  const Index3 hi = block.origin + Index3{block.dim, block.dim, block.dim};
  const Box voxels = intersect({block.origin, hi}, lattice_.domain);
  if (voxels.empty()) return;
  const Box all{lattice_.first, lattice_.first + lattice_.count};
  for_each_index(intersect(cells_of(grown(voxels, kMacrocellApron), lattice_.dim), all),
                 [&](const Index3& cell) { include(cell, block.value, block.value); });
}

// A block lies in one cell and belongs to the apron of up to seven neighbours. Each neighbour sees only the nearest
// voxels.
void MacrocellGrid::gather_coded(const NvdbGrid& grid, const GridBlock& block) {
  const Index3 hi = block.origin + Index3{kLeafDim, kLeafDim, kLeafDim};
  const Box voxels = intersect({block.origin, hi}, lattice_.domain);
  if (voxels.empty()) return;
  std::array<float, kLeafVoxels> values;
  grid.decode_block(block, values);
  const Box all{lattice_.first, lattice_.first + lattice_.count};
  for_each_index(intersect(cells_of(grown(voxels, kMacrocellApron), lattice_.dim), all), [&](const Index3& cell) {
    const Index3 lo = cell * lattice_.dim;
    const Box apron = grown({lo, lo + Index3{lattice_.dim, lattice_.dim, lattice_.dim}}, kMacrocellApron);
    MinMax seen = kNoValues;
    for_each_index(intersect(voxels, apron), [&](const Index3& voxel) {
      const Index3 i = voxel - block.origin;
      const float v = values[static_cast<std::size_t>(i.x << 6 | i.y << 3 | i.z)];
      if (!is_finite(v)) return;  // such a value, and any value filtered with it, renders as nothing
      seen.min = std::min(seen.min, v);
      seen.max = std::max(seen.max, v);
    });
    if (seen.min <= seen.max) include(cell, seen.min, seen.max);
  });
}

}  // namespace weir
