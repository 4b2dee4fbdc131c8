#include "compressor/survey/ladder_completion.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <vector>

#include "compressor/leaf/inside_voxels.h"
#include "compressor/packed/block_sample.h"
#include "compressor/survey/cached_source.h"
#include "compressor/survey/rows_to_read.h"
#include "compressor/survey/spill_sums.h"
#include "compressor/survey/surveyed_leaves.h"
#include "compressor/team/region_share.h"

namespace weir {
namespace {

// Returns whether the ladder of a leaf is built anew.
bool is_incomplete(const MissingLadders& missing, const NodeLattice& leaves, const Index3& leaf, const LeafRow& row) {
  const LadderPart part = ladder_part(row, leaves.voxels(leaf).voxels());
  return part != LadderPart::kept && (missing.all || (missing.filled && part == LadderPart::filled));
}

// Returns the part of `box` to read: the rows along x that hold incomplete leaves.
Box box_to_read(const RowStore& rows, const MissingLadders& missing, const Box& box, std::vector<LeafRow>& buffer) {
  rows.read_box(box, buffer);
  RowsToRead found(box);
  for (std::int64_t i = 0; i < box.voxels(); ++i) {
    const Index3 leaf = box.lo + index_at(i, box.extent());
    if (is_incomplete(missing, rows.leaves(), leaf, buffer[static_cast<std::size_t>(i)])) found.add(leaf);
  }
  return found.box();
}

}  // namespace

void complete_ladders(VolumeSource& source, const BlockPlan& plan, RowStore& rows, const LadderAim& aim,
                      const MissingLadders& missing, const StreamOptions& options) {
  const NodeLattice& leaves = rows.leaves();
  const OwnLeaves own(plan.lattice, rows.team());
  const BlockSample sample(leaves);
  std::vector<LeafRow> buffer;
  std::vector<Box> leaf_boxes;
  std::vector<Box> voxel_boxes;
  for (std::int64_t i = 0; i < plan.size(); ++i) {
    for (const Box& part : own.of(plan.leaf_box(i))) {
      const Box box = box_to_read(rows, missing, part, buffer);
      if (box.empty()) continue;
      leaf_boxes.push_back(box);
      voxel_boxes.push_back(plan.voxel_box(box));
    }
  }
  tbb::enumerable_thread_specific<LadderBuilder> builders([&] { return LadderBuilder(aim); });
  const auto complete = [&](const Block& block, const Index3& leaf, const LeafRow& row, PackedLadder& ladder) {
    const Box inside = leaves.voxels(leaf);
    LeafValues values;
    gather_leaf(block.values, block.voxels, leaves.node_box(leaf), inside, 0, values);
    extend_outside(leaves.node_box(leaf), inside, values);
    LadderBuilder& builder = builders.local();
    const NearRungs near = aim.near_for(row, sample.has(leaf));
    const bool finite = row.finite == inside.voxels();
    ladder = finite ? builder.build(values, row, near) : builder.build_non_finite(values, row, near);
  };
  CachedSource cached(source, rows.cache());
  rows.team().run([&] {
    stream_blocks(cached, voxel_boxes, options, [&](const Block& block) {
      const Box& box = leaf_boxes[block.index];
      const SurveyedLeaves surveyed(rows, box, source.info());
      std::vector<LeafRow> found;
      rows.read_box(box, found);
      std::vector<PackedLadder> ladders;
      rows.ladders()->read_box(box, ladders);
      tbb::parallel_for(std::int64_t{0}, box.voxels(), [&](std::int64_t i) {
        const Index3 leaf = box.lo + index_at(i, box.extent());
        const LeafRow& row = found[static_cast<std::size_t>(i)];
        if (!is_incomplete(missing, leaves, leaf, row)) return;
        surveyed.check(leaf, block.values, block.voxels);
        complete(block, leaf, row, ladders[static_cast<std::size_t>(i)]);
      });
      rows.ladders()->write_box(box, ladders);
    });
  });
  rows.team().publish(rows.ladders()->file());
}

}  // namespace weir
