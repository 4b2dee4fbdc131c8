#include "compressor/tree_plan.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <vector>

#include "format/macrocells.h"

namespace weir {
namespace {

// What merges without regard to order.
struct Tally {
  double max_abs = 0;
  bool exact = true;         // the tiles
  bool leaves_exact = true;  // at their widths
  std::array<std::uint64_t, 6> leaves_by_width{};

  void add_tile(double tile_max_abs, bool tile_exact) {
    max_abs = std::max(max_abs, tile_max_abs);
    exact = exact && tile_exact;
  }
  void add(const Tally& other) {
    add_tile(other.max_abs, other.exact);
    leaves_exact = leaves_exact && other.leaves_exact;
    for (std::size_t i = 0; i < leaves_by_width.size(); ++i) leaves_by_width[i] += other.leaves_by_width[i];
  }
};

// The leaves of an open region: the error of those that became tiles, and, returned, the one expected of the others.
double add_leaves(const TreeRegions& tree, const Fill& fill, const LeafChoices& choices, const RegionRows& rows,
                  Region& region, Tally& tally) {
  CompensatedSum squares;
  CompensatedSum expected;
  rows.for_each([&](const Index3& leaf, const LeafRow& row) {
    const LeafWidth width = choices.width(tree.mask_position(leaf));
    if (width != LeafWidth::tile) {
      ++tally.leaves_by_width[bits_log2_of(width)];
      const std::int64_t voxels = tree.leaves.voxels(leaf).voxels();
      expected.add(quantised_error(row, voxels, fill.background, width));
      tally.leaves_exact = tally.leaves_exact && keeps_every_bit(row, voxels, width);
      return;
    }
    const float value = fill.leaf_value(row);
    squares.add(row.sse_about(value));
    tally.add_tile(row.max_abs_about(value), fill.exact(row, tree.leaves.voxels(leaf).voxels(), value));
  });
  region.squared_error = squares.value();
  return expected.value();
}

void number_in_file_order(TreeRegions& tree, NodeCounts& counts) {
  tree.for_each_upper([&](std::int64_t u) {
    Upper& upper = tree.uppers[static_cast<std::size_t>(u)];
    if (!upper.open) return;
    upper.node = counts.uppers++;
    tree.for_each_region_of(u, [&](std::int64_t r) {
      Region& region = tree.regions[static_cast<std::size_t>(r)];
      if (!region.open) return;
      region.node = counts.lowers++;
      region.first_leaf = counts.leaves;
      region.first_byte = counts.leaf_bytes;
      counts.leaves += region.leaves;
      counts.leaf_bytes += region.leaf_bytes;
    });
  });
}

}  // namespace

TreePlan plan_tree(const Selection& selection, const RowStore& rows, TreeRegions& tree, ChoiceStore& store) {
  const Fill& fill = selection.rule().fill;
  tbb::enumerable_thread_specific<Tally> tallies;
  std::vector<double> expected(tree.regions.size());
  for_each_region(tree, rows, [&](std::int64_t index, const RegionRows& region_rows) {
    Region& region = tree.regions[static_cast<std::size_t>(index)];
    const LeafChoices choices = selection.choices(index, region_rows);
    const LeafPlaces::Place total = LeafPlaces(choices).total();
    region.leaves = total.leaves;
    region.leaf_bytes = total.bytes;
    store.write(index, choices);
    if (region.open) {
      expected[static_cast<std::size_t>(index)] = add_leaves(tree, fill, choices, region_rows, region, tallies.local());
    } else {
      // One tile, of this region or of the whole upper node.
      const Upper& upper = tree.uppers[static_cast<std::size_t>(tree.upper_of(index))];
      const float value = tile_value(fill, upper.open ? region.sums : upper.sums);
      region.squared_error = region.sums.sse_about(value);
      tallies.local().add_tile(region.sums.max_abs_about(value), upper.open ? region.sums.exact : upper.sums.exact);
    }
  });

  TreePlan plan;
  Tally total;
  for (const Tally& other : tallies) total.add(other);
  CompensatedSum squares;
  for (const Region& region : tree.regions) squares.add(region.squared_error);
  CompensatedSum expected_squares;
  for (const double error : expected) expected_squares.add(error);
  plan.squared_error = squares.value();
  plan.expected_leaf_error = expected_squares.value();
  plan.max_abs = total.max_abs;
  plan.lossless = total.exact;
  plan.leaves_lossless = total.leaves_exact;
  plan.leaves_by_width = total.leaves_by_width;

  NodeCounts counts;
  counts.root_tiles = tree.uppers.size();
  counts.macrocells = static_cast<std::uint64_t>(make_lattice(tree.leaves.domain, kMacrocell).size());
  number_in_file_order(tree, counts);
  plan.layout = make_layout(counts);
  return plan;
}

}  // namespace weir
