#include "compressor/survey/ladder_completion.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "compressor/packed/block_values.h"
#include "compressor/packed/near_sample.h"
#include "compressor/survey/surveyed_leaves.h"
#include "compressor/team/region_share.h"

namespace weir {
namespace {

// Whether the ladder of a leaf of so many voxels is built anew.
bool is_incomplete(const MissingLadders& missing, const LeafRow& row, std::int64_t voxels) {
  if (row.finite < voxels) return missing.filled && row.finite > 0;
  return missing.near == NearRungs::yes && !row.uniform();
}

// The leaves of a box to read: whole in x, because rows are what a file is read by.
Box box_to_read(const RowStore& rows, const MissingLadders& missing, const Box& box, std::vector<LeafRow>& buffer) {
  rows.read_box(box, buffer);
  Box found{box.hi, box.lo};
  for (std::int64_t i = 0; i < box.voxels(); ++i) {
    const Index3 leaf = box.lo + index_at(i, box.extent());
    const LeafRow& row = buffer[static_cast<std::size_t>(i)];
    if (!is_incomplete(missing, row, rows.leaves().voxels(leaf).voxels())) continue;
    found.lo = min(found.lo, leaf);
    found.hi = max(found.hi, leaf + Index3{1, 1, 1});
  }
  if (found.empty()) return found;
  found.lo.x = box.lo.x;
  found.hi.x = box.hi.x;
  return found;
}

// Bytes of a transform of that share of the block's energy as error, between two rungs; all it may take where none has.
double transform_bytes(const PackedLadder& ladder, double share) {
  double coarser = 1;
  double coarser_bits = 8;
  for (std::size_t rung = 0; rung < ladder.count; ++rung) {
    const double finer = ladder.rungs[rung].error.value();
    const auto bits = static_cast<double>(ladder.rungs[rung].bits);
    if (finer <= share) {
      const double way = finer < coarser && finer > 0 ? std::log(coarser / share) / std::log(coarser / finer) : 1;
      return (coarser_bits + way * (bits - coarser_bits)) / 8;
    }
    coarser = finer;
    coarser_bits = bits;
  }
  return kRawStreamBytes;
}

// Of one block.
NearCost near_cost(const PackedLadder& ladder, const LeafRow& row) {
  for (std::size_t rung = 0; rung < ladder.near_count; ++rung) {
    const double share = ladder.near[rung].error.value();
    const auto bytes = static_cast<double>(ladder.near[rung].bytes);
    if (share > 0 && bytes <= transform_bytes(ladder, share)) return {bytes, share * row.sse};
  }
  return {static_cast<double>(ladder.exact_bytes), 0};
}

}  // namespace

NearCost near_cost(const RowStore& rows) {
  constexpr std::int64_t kHeld = 4096;
  std::vector<LeafRow> leaf_rows(kHeld);
  std::vector<PackedLadder> ladders(kHeld);
  NearCost sampled;
  std::int64_t samples = 0;
  std::int64_t blocks = 0;
  const std::int64_t leaves = rows.leaves().size();
  for (std::int64_t first = 0; first < leaves; first += kHeld) {
    const auto count = static_cast<std::size_t>(std::min(kHeld, leaves - first));
    rows.read(first, std::span(leaf_rows).first(count));
    rows.ladders()->read(first, std::span(ladders).first(count));
    for (std::size_t i = 0; i < count; ++i) {
      const LeafRow& row = leaf_rows[i];
      if (row.finite == 0 || row.uniform()) continue;
      ++blocks;
      if (!is_near_sample(first + static_cast<std::int64_t>(i), leaves)) continue;
      ++samples;
      const NearCost cost = near_cost(ladders[i], row);
      sampled.bytes += cost.bytes;
      sampled.squared_error += cost.squared_error;
    }
  }
  if (samples == 0) return {};
  const double scale = static_cast<double>(blocks) / static_cast<double>(samples);
  return {sampled.bytes * scale, sampled.squared_error * scale};
}

void complete_ladders(VolumeSource& source, const BlockPlan& plan, RowStore& rows, const LadderAim& aim,
                      const MissingLadders& missing, const StreamOptions& options) {
  const NodeLattice& leaves = rows.leaves();
  const OwnLeaves own(plan.lattice, rows.team());
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
  const auto build = [&](const Block& block, const Index3& leaf, const LeafRow& row) {
    const Box inside = leaves.voxels(leaf);
    LeafValues values;
    gather_leaf(block.values, block.voxels, leaves.node_box(leaf), inside, 0, values);
    extend_outside(leaves.node_box(leaf), inside, values);
    LadderBuilder& builder = builders.local();
    const PackedLadder ladder = row.finite == inside.voxels() ? builder.build(values, row, missing.near)
                                                              : builder.build_non_finite(values, row, missing.near);
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
        if (!is_incomplete(missing, row, leaves.voxels(leaf).voxels())) return;
        surveyed.check(leaf, block.values, block.voxels);
        build(block, leaf, row);
      });
    });
  });
  rows.team().publish(rows.ladders()->file());
}

}  // namespace weir
