#include "compressor/encode/macrocell_builder.h"

#include <algorithm>

#include "format/nanovdb/macrocells.h"

namespace weir {
namespace {

constexpr std::int64_t kRegionCells = kLowerDim / kMacrocell;  // along a region

}  // namespace

RegionCells::RegionCells(const Index3& region_node)
    : first_(region_node * kRegionCells - Index3{1, 1, 1}), cells_(kSide * kSide * kSide, kNoBounds) {
  static_assert(kSide == kRegionCells + 2);
}

MinMax& RegionCells::at(const Index3& cell) {
  return cells_[static_cast<std::size_t>(linear_index(cell - first_, {kSide, kSide, kSide}))];
}

void RegionCells::add_tile(const Box& voxels, float value) {
  // A cell is touched by what lies in it or in its apron.
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
  const Index3 leaf = floor_div(node.lo, kLeafDim);
  const Index3 cell = floor_div(leaf, 2);
  const Index3 outward = (leaf - cell * 2) * 2 - Index3{1, 1, 1};  // -1 or +1 along each axis
  widen(at(cell), record.bounds);
  for (unsigned d = 1; d < 8; ++d) {
    const Index3 step{(d & 1U) != 0 ? outward.x : 0, (d & 2U) != 0 ? outward.y : 0, (d & 4U) != 0 ? outward.z : 0};
    widen(at(cell + step), record.outward[d - 1]);
  }
}

MacrocellBuilder::MacrocellBuilder(const Box& domain, float background)
    : lattice_(make_lattice(domain, kMacrocell)), background_(background) {}

void MacrocellBuilder::begin_layer(std::int64_t region_z) {
  const std::int64_t first = region_z * kRegionCells - 1 - lattice_.first.z;
  const std::int64_t plane = lattice_.count.x * lattice_.count.y;
  std::vector<MinMax> next(static_cast<std::size_t>(plane * RegionCells::kSide), kNoBounds);
  if (!window_.empty()) {
    // The two layers that the next region layer touches too.
    std::copy(window_.end() - 2 * plane, window_.end(), next.begin());
  }
  window_.swap(next);
  window_first_ = first;
}

void MacrocellBuilder::merge(const RegionCells& cells) {
  const std::scoped_lock lock(mutex_);
  const Index3 offset = cells.first_ - lattice_.first;
  for (std::int64_t z = 0; z < RegionCells::kSide; ++z) {
    for (std::int64_t y = 0; y < RegionCells::kSide; ++y) {
      for (std::int64_t x = 0; x < RegionCells::kSide; ++x) {
        const Index3 at = offset + Index3{x, y, z};
        if (!Box{{0, 0, 0}, lattice_.count}.contains(at)) continue;
        const Index3 in_window{at.x, at.y, at.z - window_first_};
        widen(window_[static_cast<std::size_t>(linear_index(in_window, {lattice_.count.x, lattice_.count.y, 0}))],
              cells.cells_[static_cast<std::size_t>(
                  linear_index({x, y, z}, {RegionCells::kSide, RegionCells::kSide, 0}))]);
      }
    }
  }
}

std::vector<MinMax> MacrocellBuilder::take_finished(bool last, std::int64_t& first_layer) {
  const std::int64_t keep = last ? 0 : 2;
  first_layer = std::max<std::int64_t>(0, window_first_);
  const std::int64_t end = std::min(lattice_.count.z, window_first_ + RegionCells::kSide - keep);
  std::vector<MinMax> cells;
  for (std::int64_t layer = first_layer; layer < end; ++layer) finish(layer, cells);
  return cells;
}

void MacrocellBuilder::finish(std::int64_t layer, std::vector<MinMax>& cells) const {
  const Index3 apron{kMacrocellApron, kMacrocellApron, kMacrocellApron};
  for (std::int64_t y = 0; y < lattice_.count.y; ++y) {
    for (std::int64_t x = 0; x < lattice_.count.x; ++x) {
      const Index3 in_window{x, y, layer - window_first_};
      MinMax bounds =
          window_[static_cast<std::size_t>(linear_index(in_window, {lattice_.count.x, lattice_.count.y, 0}))];
      const Box box = lattice_.node_box({x, y, layer});
      if (!lattice_.domain.contains(Box{box.lo - apron, box.hi + apron})) widen(bounds, {background_, background_});
      // Nothing but NaN in reach: no majorant is asked for, but readers expect min <= max.
      if (bounds.min > bounds.max) bounds = {background_, background_};
      // A zero's sign is that of the region merged first: make it one.
      cells.push_back({bounds.min + 0.0F, bounds.max + 0.0F});
    }
  }
}

}  // namespace weir
