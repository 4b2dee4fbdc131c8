#include "compressor/survey/filled_ladders.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <span>
#include <vector>

#include "compressor/packed/block_values.h"
#include "compressor/survey/surveyed_leaves.h"
#include "compressor/team/region_share.h"

namespace weir {
namespace {

bool some_finite(const LeafRow& row, std::int64_t voxels) { return row.finite > 0 && row.finite < voxels; }

// The leaves of a box to read: whole in x, because rows are what a file is read by.
Box box_to_read(const RowStore& rows, const Box& box, std::vector<LeafRow>& buffer) {
  rows.read_box(box, buffer);
  Box found{box.hi, box.lo};
  for (std::int64_t i = 0; i < box.voxels(); ++i) {
    const Index3 leaf = box.lo + index_at(i, box.extent());
    if (!some_finite(buffer[static_cast<std::size_t>(i)], rows.leaves().voxels(leaf).voxels())) continue;
    found.lo = min(found.lo, leaf);
    found.hi = max(found.hi, leaf + Index3{1, 1, 1});
  }
  if (found.empty()) return found;
  found.lo.x = box.lo.x;
  found.hi.x = box.hi.x;
  return found;
}

}  // namespace

void build_filled_ladders(VolumeSource& source, const BlockPlan& plan, RowStore& rows, const LadderAim& aim,
                          const StreamOptions& options) {
  const NodeLattice& leaves = rows.leaves();
  const OwnLeaves own(plan.lattice, rows.team());
  std::vector<LeafRow> buffer;
  std::vector<Box> leaf_boxes;
  std::vector<Box> voxel_boxes;
  for (std::int64_t i = 0; i < plan.size(); ++i) {
    for (const Box& part : own.of(plan.leaf_box(i))) {
      const Box box = box_to_read(rows, part, buffer);
      if (box.empty()) continue;
      leaf_boxes.push_back(box);
      voxel_boxes.push_back(plan.voxel_box(box));
    }
  }
  tbb::enumerable_thread_specific<LadderBuilder> builders([&] { return LadderBuilder(aim); });
  const auto build = [&](const Block& block, const Index3& leaf, const LeafRow& row) {
    const Box inside = leaves.voxels(leaf);
    LeafValues values;
    gather_leaf(block.values, block.voxels, leaves.node_box(leaf), inside, *aim.background, values);
    extend_outside(leaves.node_box(leaf), inside, values);
    const PackedLadder ladder = builders.local().build_non_finite(values, row);
    rows.ladders()->write(leaves.linear(leaf), std::span(&ladder, 1));
  };
  rows.team().run([&] {
    stream_blocks(source, voxel_boxes, options, [&](const Block& block) {
      const Box& box = leaf_boxes[block.index];
      const SurveyedLeaves surveyed(rows, box, source.info());
      std::vector<LeafRow> found;
      rows.read_box(box, found);
      tbb::parallel_for(std::int64_t{0}, box.voxels(), [&](std::int64_t i) {
        const Index3 leaf = box.lo + index_at(i, box.extent());
        const LeafRow& row = found[static_cast<std::size_t>(i)];
        if (!some_finite(row, leaves.voxels(leaf).voxels())) return;
        surveyed.check(leaf, block.values, block.voxels);
        build(block, leaf, row);
      });
    });
  });
  rows.team().publish(rows.ladders()->file());
}

}  // namespace weir
