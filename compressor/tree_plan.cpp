#include "compressor/tree_plan.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>

#include "format/macrocells.h"

namespace weir {
namespace {

// Worst error and exactness over what is dropped; merges without regard to order.
struct Worst {
  double max_abs = 0;
  bool exact = true;

  void add(const Worst& other) {
    max_abs = std::max(max_abs, other.max_abs);
    exact = exact && other.exact;
  }
};

// Error of the leaves of an open region that became tiles.
void add_dropped_leaves(const TreeRegions& tree, const Fill& fill, const LeafMask& mask, const RegionRows& rows,
                        Region& region, Worst& worst) {
  CompensatedSum squares;
  rows.for_each([&](const Index3& leaf, const LeafRow& row) {
    if (mask.test(tree.mask_position(leaf))) return;
    const float value = fill.leaf_value(row);
    squares.add(row.sse_about(value));
    worst.add({row.max_abs_about(value), fill.exact(row, tree.leaves.voxels(leaf).voxels(), value)});
  });
  region.squared_error = squares.value();
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
      counts.leaves += region.leaves;
    });
  });
}

}  // namespace

TreePlan plan_tree(const Selection& selection, const RowStore& rows, TreeRegions& tree, MaskStore& masks) {
  const Fill& fill = selection.rule().fill;
  tbb::enumerable_thread_specific<Worst> worsts;
  for_each_region(tree, rows, [&](std::int64_t index, const RegionRows& region_rows) {
    Region& region = tree.regions[static_cast<std::size_t>(index)];
    const LeafMask mask = selection.mask(index, region_rows);
    region.leaves = mask.count();
    masks.write(index, mask);
    if (region.open) {
      add_dropped_leaves(tree, fill, mask, region_rows, region, worsts.local());
    } else {
      // One tile, of this region or of the whole upper node.
      const Upper& upper = tree.uppers[static_cast<std::size_t>(tree.upper_of(index))];
      const float value = tile_value(fill, upper.open ? region.sums : upper.sums);
      region.squared_error = region.sums.sse_about(value);
      worsts.local().add({region.sums.max_abs_about(value), upper.open ? region.sums.exact : upper.sums.exact});
    }
  });

  TreePlan plan;
  Worst worst;
  for (const Worst& other : worsts) worst.add(other);
  CompensatedSum squares;
  for (const Region& region : tree.regions) squares.add(region.squared_error);
  plan.squared_error = squares.value();
  plan.max_abs = worst.max_abs;
  plan.lossless = worst.exact;

  NodeCounts counts;
  counts.root_tiles = tree.uppers.size();
  counts.macrocells = static_cast<std::uint64_t>(make_lattice(tree.leaves.domain, kMacrocell).size());
  number_in_file_order(tree, counts);
  counts.leaf_bytes = counts.leaves * nvdb::kFloatLeafBytes;
  plan.layout = make_layout(counts);
  return plan;
}

}  // namespace weir
