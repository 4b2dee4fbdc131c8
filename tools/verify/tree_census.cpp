#include "tools/verify/tree_census.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "format/leaf/leaf_decode.h"
#include "tools/verify/packed_census.h"

namespace weir {
namespace {

constexpr std::size_t kLeafBatch = 8192;  // leaves in one batch: some milliseconds of work

std::size_t tile_level(std::int64_t dim) { return dim == kLeafDim ? 0 : dim == kLowerDim ? 1 : 2; }

void include(Box& box, const Box& other) {
  if (other.empty()) return;
  box = box.empty() ? other : Box{min(box.lo, other.lo), max(box.hi, other.hi)};
}

Index3 voxel_of(unsigned n) { return {n >> 6U, n >> 3U & 7U, n & 7U}; }
std::int64_t index_in_leaf(const Index3& voxel) { return voxel.x << 6 | voxel.y << 3 | voxel.z; }

using Walk = void (NvdbGrid::*)(const std::function<void(const GridBlock&)>&) const;

bool voxel_active(const NvdbGrid& grid, const GridBlock& block, unsigned n) {
  return block.leaf != nullptr ? leaf_active(block.leaf, n) : grid.index_bbox().contains(block.origin + voxel_of(n));
}

// Returns the voxels of a constant block that count: for a packed grid only those inside the index box.
Box tile_box(const NvdbGrid& grid, const GridBlock& tile, bool of_tree) {
  const Box box{tile.origin, tile.origin + Index3{tile.dim, tile.dim, tile.dim}};
  return of_tree ? box : intersect(box, grid.index_bbox());
}

// Calls on_tile for every constant block that `walk` visits, in this thread, and reduces the coded blocks batch by
// batch on all threads. `Tally` has add(const GridBlock& block, std::span<const float, 512> values) and merge(const
// Tally&).
template <typename Tally, typename OnTile>
Tally reduce_blocks(const NvdbGrid& grid, Walk walk, const Tally& zero, const CensusProgress& progress,
                    const OnTile& on_tile, Trace* trace = nullptr) {
  Tally total = zero;
  std::vector<GridBlock> batch;
  std::uint64_t done = 0;
  const auto flush = [&] {
    total.merge(tbb::parallel_deterministic_reduce(
        tbb::blocked_range<std::size_t>(0, batch.size(), 256), zero,
        [&](const tbb::blocked_range<std::size_t>& range, Tally part) {
          std::array<float, kLeafVoxels> values{};
          const TraceSpan span(trace, "decode", range.size() * sizeof values);
          for (std::size_t i = range.begin(); i < range.end(); ++i) {
            grid.decode_block(batch[i], values);
            part.add(batch[i], values);
          }
          return part;
        },
        [](Tally left, const Tally& right) {
          left.merge(right);
          return left;
        }));
    done += batch.size();
    batch.clear();
    if (progress) progress(done);
  };
  (grid.*walk)([&](const GridBlock& block) {
    if (!block.coded()) return on_tile(total, block);
    batch.push_back(block);
    if (batch.size() == kLeafBatch) flush();
  });
  flush();
  return total;
}

class CensusTally {
 public:
  /// `of_tree`: the tree is visited. Otherwise the packed data are visited; macrocells are then checked too, because
  /// they hold bounds of what a grid decodes to.
  CensusTally(const NvdbGrid& grid, bool of_tree)
      : grid_(&grid),
        of_tree_(of_tree),
        background_(grid.background()),
        cells_(of_tree == (grid.packed() == nullptr) ? grid.macrocells() : MacrocellView{}) {}

  void add(const GridBlock& block, std::span<const float, 512> values) {
    ++census.leaves;
    if (of_tree_) ++census.leaves_by_bits[static_cast<std::size_t>(std::bit_width(grid_->leaf_bits(block.leaf)) - 1)];
    const Box box{block.origin, block.origin + Index3{kLeafDim, kLeafDim, kLeafDim}};
    const Box inside = intersect(box, grid_->index_bbox());
    if (inside == box && (!of_tree_ || all_active(block.leaf))) {
      add_whole(block, box, values);
    } else {
      add_partial(block, inside, values);
    }
  }

  void add_tile(const GridBlock& tile) {
    ++(tile.active ? census.active_tiles : census.inactive_tiles)[tile_level(tile.dim)];
    const Box box = tile_box(*grid_, tile, of_tree_);
    if (tile.active) {
      census.active_voxels += static_cast<std::uint64_t>(box.voxels());
      add_value(tile.value, static_cast<std::uint64_t>(box.voxels()));
      include(census.active_bbox, box);
    }
    const Box inside = intersect(box, grid_->index_bbox());
    if (inside.empty()) return;
    if (!tile.active && tile.value == background_) census.quiet_voxels += static_cast<std::uint64_t>(inside.voxels());
    for_each_index(cells_that_see(inside), [&](const Index3& cell) { check(tile.origin, inside, cell, tile.value); });
  }

  // Checks the cells whose apron reaches beyond the domain, where voxels count as background.
  void check_border() {
    if (cells_.cells.empty()) return;
    const NodeLattice& lattice = cells_.lattice;
    for_each_index({lattice.first, lattice.first + lattice.count}, [&](const Index3& cell) {
      if (!lattice.domain.contains(seen_from(cell))) check({}, {}, cell, background_);
    });
  }

  void merge(const CensusTally& other) {
    const TreeCensus& o = other.census;
    census.leaves += o.leaves;
    for (std::size_t i = 0; i < o.leaves_by_bits.size(); ++i) census.leaves_by_bits[i] += o.leaves_by_bits[i];
    census.active_voxels += o.active_voxels;
    census.nonfinite += o.nonfinite;
    census.zeros += o.zeros;
    census.backgrounds += o.backgrounds;
    census.quiet_voxels += o.quiet_voxels;
    include(census.active_bbox, o.active_bbox);
    census.min = std::min(census.min, o.min);
    census.max = std::max(census.max, o.max);
    if (!census.outside_macrocell) census.outside_macrocell = o.outside_macrocell;
    if (!census.outside_apron) census.outside_apron = o.outside_apron;
  }

  TreeCensus census;

 private:
  static bool all_active(const std::byte* leaf) {
    const std::byte* mask = leaf + nvdb::leaf::kValueMask;
    return std::all_of(mask, mask + kLeafVoxels / 8, [](std::byte b) { return b == std::byte{255}; });
  }

  // Adds the usual leaf, wholly inside and active, for which the extremes suffice.
  void add_whole(const GridBlock& leaf, const Box& box, std::span<const float, 512> values) {
    float lo = std::numeric_limits<float>::infinity();
    float hi = -lo;
    float not_finite = 0;  // x * 0 is 0 for a finite x, else NaN
    unsigned zeros = 0;
    unsigned backgrounds = 0;
    for (const float value : values) {
      lo = value < lo ? value : lo;
      hi = value > hi ? value : hi;
      not_finite += value * 0.0F;
      zeros += value == 0.0F ? 1U : 0U;
      backgrounds += value == background_ ? 1U : 0U;
    }
    if (std::isnan(not_finite)) return add_partial(leaf, box, values);
    census.active_voxels += values.size();
    census.zeros += zeros;
    census.backgrounds += backgrounds;
    census.min = std::min(census.min, lo);
    census.max = std::max(census.max, hi);
    include(census.active_bbox, box);
    check_cells(leaf, box, values, {lo, hi});
  }

  void add_partial(const GridBlock& leaf, const Box& inside, std::span<const float, 512> values) {
    MinMax all{std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};
    for (unsigned n = 0; n < values.size(); ++n) {
      const Index3 i = leaf.origin + voxel_of(n);
      if (voxel_active(*grid_, leaf, n)) {
        ++census.active_voxels;
        add_value(values[n], 1);
        include(census.active_bbox, {i, i + Index3{1, 1, 1}});
      }
      if (!inside.contains(i)) continue;
      all.min = values[n] < all.min ? values[n] : all.min;
      all.max = values[n] > all.max ? values[n] : all.max;
    }
    check_cells(leaf, inside, values, all);
  }

  // The cells that see voxels of a block in the domain: their own, and those into whose apron they reach. `all` are
  // bounds of what the block has inside.
  void check_cells(const GridBlock& block, const Box& inside, std::span<const float, 512> values, const MinMax& all) {
    for_each_index(cells_that_see(inside), [&](const Index3& cell) {
      const MinMax& bounds = cell_at(cell);
      if (all.min >= bounds.min && all.max <= bounds.max) return;
      for_each_index(intersect(inside, seen_from(cell)), [&](const Index3& i) {
        check(block.origin, inside, cell, values[static_cast<std::size_t>(index_in_leaf(i - block.origin))]);
      });
    });
  }

  void add_value(float value, std::uint64_t voxels) {
    if (!std::isfinite(value)) {
      census.nonfinite += voxels;
      return;
    }
    if (value == 0.0F) census.zeros += voxels;
    if (value == background_) census.backgrounds += voxels;
    census.min = std::min(census.min, value);
    census.max = std::max(census.max, value);
  }

  const MinMax& cell_at(const Index3& cell) const {
    return cells_.cells[static_cast<std::size_t>(cells_.lattice.linear(cell - cells_.lattice.first))];
  }

  Box box_of(const Index3& cell) const { return cells_.lattice.node_box(cell - cells_.lattice.first); }

  // Returns the voxels that the bounds of `cell` cover.
  Box seen_from(const Index3& cell) const { return grown(box_of(cell), cells_.apron); }

  // Returns the cells whose bounds cover some of `voxels`; empty if the grid has no macrocells.
  Box cells_that_see(const Box& voxels) const {
    if (cells_.cells.empty() || voxels.empty()) return {};
    const NodeLattice& lattice = cells_.lattice;
    const Box reach = grown(voxels, cells_.apron);
    const Box cells{floor_div(reach.lo, cells_.cell),
                    floor_div(reach.hi - Index3{1, 1, 1}, cells_.cell) + Index3{1, 1, 1}};
    return intersect(cells, {lattice.first, lattice.first + lattice.count});
  }

  // Checks `value` against the bounds of `cell`. NaN is not checked: it has no extinction. `block` has the value in
  // `voxels`, which lie in the cell or only in its apron.
  void check(const Index3& block, const Box& voxels, const Index3& cell, float value) {
    const MinMax& bounds = cell_at(cell);
    if (std::isnan(value) || (value >= bounds.min && value <= bounds.max)) return;
    const bool own = !intersect(voxels, box_of(cell)).empty();
    std::optional<Index3>& found = own ? census.outside_macrocell : census.outside_apron;
    if (!found) found = own ? block : box_of(cell).lo;
  }

  const NvdbGrid* grid_;
  bool of_tree_;
  float background_;
  MacrocellView cells_;
};

class HistogramTally {
 public:
  HistogramTally(const NvdbGrid& grid, float lo, float hi, std::size_t bins)
      : counts(bins), grid_(&grid), lo_(lo), hi_(hi) {}

  void add(const GridBlock& leaf, std::span<const float, 512> values) {
    for (unsigned n = 0; n < values.size(); ++n) {
      if (voxel_active(*grid_, leaf, n)) add_value(values[n], 1);
    }
  }
  void add_value(float value, std::uint64_t voxels) {
    if (!(value >= lo_ && value <= hi_)) return;
    const double position = (static_cast<double>(value) - lo_) / (static_cast<double>(hi_) - lo_);
    const auto bin = static_cast<std::size_t>(position * static_cast<double>(counts.size()));
    counts[std::min(bin, counts.size() - 1)] += voxels;
  }
  void merge(const HistogramTally& other) {
    for (std::size_t i = 0; i < counts.size(); ++i) counts[i] += other.counts[i];
  }

  std::vector<std::uint64_t> counts;

 private:
  const NvdbGrid* grid_;
  float lo_;
  float hi_;
};

}  // namespace

TreeCensus take_census(const NvdbGrid& grid, const CensusProgress& progress, Trace* trace) {
  const auto add_tile = [](CensusTally& total, const GridBlock& tile) { total.add_tile(tile); };
  const auto census_of = [&](bool tree) {
    const Walk walk = tree ? &NvdbGrid::for_each_tree_block : &NvdbGrid::for_each_block;
    CensusTally tally = reduce_blocks(grid, walk, CensusTally(grid, tree), progress, add_tile, trace);
    tally.check_border();
    return tally.census;
  };
  TreeCensus census = census_of(true);
  census.valued_voxels = census.active_voxels;
  if (grid.packed() == nullptr) return census;
  const TreeCensus values = census_of(false);
  census.nonfinite = values.nonfinite;
  census.zeros = values.zeros;
  census.backgrounds = values.backgrounds;
  census.quiet_voxels = values.quiet_voxels;
  census.valued_voxels = values.active_voxels;
  census.min = values.min;
  census.max = values.max;
  census.outside_macrocell = values.outside_macrocell;
  census.outside_apron = values.outside_apron;
  return census;
}

std::uint64_t census_blocks(const NvdbGrid& grid) {
  return grid.packed() != nullptr ? packed_block_count(*grid.packed()) : grid.node_counts()[0];
}

std::vector<std::uint64_t> count_values(const NvdbGrid& grid, float lo, float hi, std::size_t bins,
                                        const CensusProgress& progress) {
  return reduce_blocks(grid, &NvdbGrid::for_each_block, HistogramTally(grid, lo, hi, bins), progress,
                       [&](HistogramTally& total, const GridBlock& tile) {
                         if (!tile.active) return;
                         const Box box = tile_box(grid, tile, grid.packed() == nullptr);
                         total.add_value(tile.value, static_cast<std::uint64_t>(box.voxels()));
                       })
      .counts;
}

Sidecar::Histogram finite_histogram(const NvdbGrid& grid, const MinMax& range, std::size_t bins,
                                    const CensusProgress& progress) {
  auto [lo, hi] = range;
  if (!std::isfinite(lo) || !std::isfinite(hi)) {
    const TreeCensus census = take_census(grid, [&](std::uint64_t) {
      if (progress) progress(0);
    });
    lo = census.min;
    hi = census.max;
  }
  Sidecar::Histogram histogram{lo, hi, {}};
  if (lo < hi) {
    histogram.counts = count_values(grid, lo, hi, bins, progress);
  } else if (lo == hi) {  // from the value to the next number towards 0, which is never infinite
    const float next = std::nextafter(lo, lo == 0 ? 1.0F : 0.0F);
    histogram.counts = count_values(grid, std::min(lo, next), std::max(lo, next), 1, progress);
  }
  const bool empty = std::ranges::all_of(histogram.counts, [](std::uint64_t count) { return count == 0; });
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  return empty ? Sidecar::Histogram{kNone, kNone, {}} : histogram;
}

}  // namespace weir
