#include "compressor/encode/macrocell_builder.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "format/nanovdb/macrocells.h"

namespace weir {
namespace {

constexpr std::int64_t kRegionCells = kLowerDim / kMacrocell;  // cells along one axis of a region

}  // namespace

std::uint64_t macrocell_window_bytes(const Box& domain) {
  const Index3 cells = make_lattice(domain, kMacrocell).count;
  const std::int64_t window = std::min(kRegionCells + 2, cells.z);
  const std::int64_t finished = std::min(kRegionCells, cells.z);
  // Two windows exist while the window moves.
  return static_cast<std::uint64_t>((2 * window + finished) * cells.x * cells.y) * sizeof(MinMax);
}

RegionCells::RegionCells(const Index3& region_node)
    : first_(region_node * kRegionCells - Index3{1, 1, 1}), cells_(kSide * kSide * kSide, kNoBounds) {
  static_assert(kSide == kRegionCells + 2);
}

MinMax& RegionCells::at(const Index3& cell) {
  return cells_[static_cast<std::size_t>(linear_index(cell - first_, {kSide, kSide, kSide}))];
}

void RegionCells::add_tile(const Box& voxels, float value) {
  // A voxel touches each cell that has the voxel inside or in the apron.
  const Index3 apron{kMacrocellApron, kMacrocellApron, kMacrocellApron};
  const Index3 lo = floor_div(voxels.lo - apron, kMacrocell);
  const Index3 last = floor_div(voxels.hi - Index3{1, 1, 1} + apron, kMacrocell);
  for (std::int64_t z = lo.z; z <= last.z; ++z) {
    for (std::int64_t y = lo.y; y <= last.y; ++y) {
      for (std::int64_t x = lo.x; x <= last.x; ++x) widen(at({x, y, z}), {value, value});
    }
  }
}

void RegionCells::add_leaf(const Box& node, const LeafRecord& record) {
  // The leaf's position, counted from the first cell: each cell has two leaves along each axis.
  const Index3 leaf = floor_div(node.lo, kLeafDim) - first_ * 2;
  const Index3 cell{leaf.x >> 1, leaf.y >> 1, leaf.z >> 1};
  const auto outward = [](std::int64_t of_leaf, std::int64_t step) { return (of_leaf & 1) != 0 ? step : -step; };
  const std::int64_t x = outward(leaf.x, 1);
  const std::int64_t y = outward(leaf.y, kSide);
  const std::int64_t z = outward(leaf.z, kSide * kSide);
  MinMax* const own = cells_.data() + linear_index(cell, {kSide, kSide, kSide});
  widen(*own, record.bounds);
  for (unsigned d = 1; d < 8; ++d) {
    const std::int64_t step = ((d & 1U) != 0 ? x : 0) + ((d & 2U) != 0 ? y : 0) + ((d & 4U) != 0 ? z : 0);
    widen(own[step], record.outward[d - 1]);
  }
}

MacrocellBuilder::MacrocellBuilder(const Box& domain, float background)
    : lattice_(make_lattice(domain, kMacrocell)), background_(background) {}

void MacrocellBuilder::begin_layers(std::int64_t region_z, std::int64_t layers) {
  const std::int64_t own_first = region_z * kRegionCells - lattice_.first.z;
  const std::int64_t first = std::max<std::int64_t>(0, own_first - 1);
  settled_ = own_first + layers * kRegionCells - 1;
  const std::int64_t end = std::min(lattice_.count.z, settled_ + 2);
  std::vector<MinMax> next(static_cast<std::size_t>(plane() * (end - first)), kNoBounds);
  // The last layers of the old window hold what earlier regions have touched of the new layers.
  if (!window_.empty()) std::copy(window_.begin() + plane() * (first - window_first_), window_.end(), next.begin());
  window_first_ = first;
  window_.swap(next);
}

void MacrocellBuilder::merge(const RegionCells& cells) {
  const Index3 offset = cells.first_ - lattice_.first;
  const Index3 side{RegionCells::kSide, RegionCells::kSide, RegionCells::kSide};
  const Box inside = intersect({offset, offset + side}, {{0, 0, 0}, lattice_.count});
  const auto x_cells = static_cast<std::size_t>(std::max<std::int64_t>(0, inside.hi.x - inside.lo.x));
  const std::scoped_lock lock(mutex_);
  for (std::int64_t z = inside.lo.z; z < inside.hi.z; ++z) {
    for (std::int64_t y = inside.lo.y; y < inside.hi.y; ++y) {
      const MinMax* const from = cells.cells_.data() + linear_index(Index3{inside.lo.x, y, z} - offset, side);
      MinMax* const to = window_.data() + linear_index({inside.lo.x, y, z - window_first_}, lattice_.count);
      for (std::size_t x = 0; x < x_cells; ++x) widen(to[x], from[x]);
    }
  }
}

std::vector<MinMax> MacrocellBuilder::take_finished(bool last, std::int64_t& first_layer) {
  first_layer = window_first_;
  const std::int64_t end = last ? lattice_.count.z : std::min(lattice_.count.z, settled_);
  std::vector<MinMax> cells(static_cast<std::size_t>(plane() * (end - first_layer)));
  tbb::parallel_for(first_layer, end,
                    [&](std::int64_t layer) { finish(layer, cells.data() + plane() * (layer - first_layer)); });
  return cells;
}

void MacrocellBuilder::finish(std::int64_t layer, MinMax* cells) const {
  const Index3 apron{kMacrocellApron, kMacrocellApron, kMacrocellApron};
  const MinMax* from = window_.data() + plane() * (layer - window_first_);
  for (std::int64_t y = 0; y < lattice_.count.y; ++y) {
    for (std::int64_t x = 0; x < lattice_.count.x; ++x) {
      MinMax bounds = *from++;
      const Box box = lattice_.node_box({x, y, layer});
      if (!lattice_.domain.contains(Box{box.lo - apron, box.hi + apron})) widen(bounds, {background_, background_});
      // Only NaN lies in reach. Such a cell needs no majorant, but readers expect min <= max.
      if (bounds.min > bounds.max) bounds = {background_, background_};
      // The sign of a zero depends on which region was merged first. Adding 0.0 makes every zero positive.
      *cells++ = {bounds.min + 0.0F, bounds.max + 0.0F};
    }
  }
}

}  // namespace weir
