#include "compressor/survey/block_survey.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "compressor/leaf/finite_values.h"
#include "compressor/leaf/leaf_in_block.h"
#include "compressor/packed/block_values.h"
#include "compressor/survey/side_by_side.h"

namespace weir {

BlockSurvey::ValueTable BlockSurvey::value_table(const SourceInfo& info) {
  if (!info.values_as_stored()) return {};
  switch (info.type) {
    case ScalarType::uint8:
      return {0, 256};
    case ScalarType::int8:
      return {-128, 256};
    case ScalarType::uint16:
      return {0, 65536};
    case ScalarType::int16:
      return {-32768, 65536};
    default:
      return {};
  }
}

// Surveys the leaves of one block.
class BlockSurvey::Leaves {
 public:
  // `faces` and `ladders` are empty if they are not wanted.
  Leaves(const BlockSurvey& survey, const Block& block, const Box& leaf_box, std::span<LeafRow> rows,
         std::span<LeafFaces> faces, std::span<PackedLadder> ladders)
      : leaves_(survey.rows_.leaves()),
        table_(survey.table_),
        widths_(survey.widths_),
        aim_(survey.ladders_),
        sample_(survey.sample_),
        counting_(survey.counting_),
        has_missing_(survey.has_missing_),
        cache_(block.parts == nullptr ? survey.rows_.cache() : nullptr),
        block_(block),
        leaf_box_(leaf_box),
        rows_(rows),
        faces_(faces),
        ladders_(ladders) {}

  // Returns a function that stores the row of a leaf that SideBySide held back, and counts its values.
  auto keep_row(Tally& tally) const {
    return [this, &tally](const SideBySide::Leaf& leaf, std::span<const float> distinct, const LeafRow& row) {
      rows_[leaf.at] = row;
      tally.finite += row.finite;
      count_values(distinct, kLeafVoxels / distinct.size(), row, tally);
      add_sums(leaf.linear, leaf.at, tally);
    };
  }

  // Surveys leaves [first, end) of the block, x fastest.
  void run(std::int64_t first, std::int64_t end, Tally& tally) const {
    SideBySide held(widths_);
    for_each_leaf(first, end, [&](std::size_t at, const Index3& leaf) {
      if (!survey_leaf(leaf, at, held, tally)) return;
      add_sums(leaves_.linear(leaf), at, tally);
      if (!ladders_.empty()) add_sum(leaf, rows_[at], ladders_[at], tally);
    });
    held.finish(keep_row(tally));
  }

  // Builds the ladders of leaves [first, end). Their rows must exist. Uses what a coder has `found`, if it is enough.
  void run_ladders(std::int64_t first, std::int64_t end, const std::optional<SurveyedBlocks>& found,
                   std::span<PackedLadder> ladders, Tally& tally) const {
    for_each_leaf(first, end, [&](std::size_t at, const Index3& leaf) {
      const LeafRow& row = rows_[at];
      const auto count = static_cast<std::size_t>(leaves_.voxels(leaf).voxels());
      if (found && row.finite == count && !row.uniform()) {
        const NearRungs near = aim_->near_for(row, sample_.has(leaf));
        const auto ladder = tally.builder(*aim_).build_from(found->block(at), row, near);
        if (ladder) {
          ladders[at] = *ladder;
          add_sum(leaf, row, ladders[at], tally);
          return;
        }
      }
      std::array<float, kLeafVoxels> values;
      ladders[at] = ladder_of(leaf, gather(leaf, values), row, tally);
      add_sum(leaf, row, ladders[at], tally);
    });
  }

 private:
  void add_sums(std::int64_t linear, std::size_t at, Tally& tally) const {
    tally.sums.add(linear, rows_[at]);
    if (!faces_.empty()) tally.sums.add(linear, faces_[at]);
  }
  void add_sum(const Index3& leaf, const LeafRow& row, const PackedLadder& ladder, Tally& tally) const {
    tally.sums.add(leaves_.linear(leaf), ladder, ladder_part(row, leaves_.voxels(leaf).voxels()));
  }

  // Calls visit(at, leaf) for leaves [first, end) of the block, x fastest.
  template <typename Visit>
  void for_each_leaf(std::int64_t first, std::int64_t end, const Visit& visit) const {
    Index3 leaf = leaf_box_.lo + index_at(first, leaf_box_.extent());
    for (auto at = static_cast<std::size_t>(first); at < static_cast<std::size_t>(end); ++at) {
      visit(at, leaf);
      if (++leaf.x < leaf_box_.hi.x) continue;
      leaf.x = leaf_box_.lo.x;
      if (++leaf.y < leaf_box_.hi.y) continue;
      leaf.y = leaf_box_.lo.y;
      ++leaf.z;
    }
  }

  // Returns the in-domain values of a leaf, x fastest.
  std::span<const float> gather(const Index3& leaf, std::array<float, kLeafVoxels>& values) const {
    // Prefetches the next leaf but one, which lies in another cache line.
    return copy_leaf(block_.values, block_.voxels, leaves_.voxels(leaf), 2 * kLeafDim, values);
  }

  // Surveys leaf number `at` of the block and returns true, or gives the leaf to `held` and returns false.
  bool survey_leaf(const Index3& leaf, std::size_t at, SideBySide& held, Tally& tally) const {
    const Box inside = leaves_.voxels(leaf);
    const Index3 extent = inside.extent();
    LeafRow& row = rows_[at];
    PackedLadder* const ladder = ladders_.empty() ? nullptr : &ladders_[at];
    LeafRoom room;
    const LeafInBlock in_part = block_.parts == nullptr ? LeafInBlock{} : leaf_in_block(block_, inside, room);
    const std::span<const float> seen = block_.parts == nullptr ? gather(leaf, room.values) : in_part.values;
    const std::span<const float> distinct = in_part.distinct.empty() ? seen : in_part.distinct;
    const Index3& by = in_part.by;
    const LeafRepeats repeats = seen.size() == kLeafVoxels ? LeafRepeats::in_source_order(by) : LeafRepeats{};
    const std::size_t count = seen.size();
    const std::int64_t linear = leaves_.linear(leaf);
    const std::size_t sample = sample_position(linear, count);
    if (!faces_.empty()) faces_[at] = faces_of(seen, extent);
    if (ladder == nullptr && count == kLeafVoxels && LaneShape::suits(by) && LeafLanes::takes(distinct)) {
      held.add({at, linear, seen[sample], leaf_digest(seen)}, distinct, by, keep_row(tally));
      return false;
    }
    row = summarize_leaf(seen, sample, tally.uniform, distinct, repeats);
    if (cache_ != nullptr) cache_->add(linear, seen, (row.uniform() || row.finite == 0) && holds_one_value(seen));
    if (ladder != nullptr) *ladder = ladder_of(leaf, seen, row, tally);
    tally.finite += row.finite;
    if (row.finite == count) {
      count_values(distinct, count / distinct.size(), row, tally);
      if (widths_) summarize_widths(seen, distinct, repeats, row);
    } else {
      count_non_finite(seen, inside, row, tally);
    }
    return true;
  }

  PackedLadder ladder_of(const Index3& leaf, std::span<const float> values, const LeafRow& row, Tally& tally) const {
    const bool all = row.finite == values.size();
    if (all && row.uniform()) return LadderBuilder::uniform();
    LeafValues block;
    block_values(values, leaves_.node_box(leaf), leaves_.voxels(leaf), block);
    const NearRungs rungs = aim_->near_for(row, sample_.has(leaf));
    return all ? tally.builder(*aim_).build(block, row, rungs)
               : tally.builder(*aim_).build_non_finite(block, row, rungs);
  }

  // Counts each value of `finite` `times` times.
  void count_values(std::span<const float> finite, std::size_t times, const LeafRow& row, Tally& tally) const {
    tally.min = std::min(tally.min, row.min);
    tally.max = std::max(tally.max, row.max);
    if (counting_ == Counting::elsewhere) return;
    if (table_.size > 0) {
      const auto offset = static_cast<float>(table_.offset);
      if (row.uniform()) {
        tally.value_counts[static_cast<std::size_t>(row.mean - offset)] += times * finite.size();
      } else {
        for (const float v : finite) tally.value_counts[static_cast<std::size_t>(v - offset)] += times;
      }
    } else if (row.uniform()) {
      tally.histogram.add(row.mean, times * finite.size());
    } else {
      tally.histogram.add(finite, row.min, row.max, times);
    }
  }

  void count_non_finite(std::span<const float> values, const Box& inside, LeafRow& row, Tally& tally) const {
    std::array<float, kLeafVoxels> finite;
    std::size_t kept = 0;
    std::size_t missing = 0;
    const Index3 extent = inside.extent();
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (std::isfinite(values[i])) {
        finite[kept++] = values[i];
        continue;
      }
      const Index3 voxel = inside.lo + index_at(static_cast<std::int64_t>(i), extent);
      const std::int64_t at = linear_index(voxel - leaves_.domain.lo, leaves_.domain.extent());
      if (has_missing_ && is_missing(values[i])) {
        ++missing;
        tally.first_missing = std::min(tally.first_missing, at);
      } else if (at < tally.first_non_finite) {
        tally.first_non_finite = at;
        tally.first_non_finite_value = values[i];
      }
    }
    tally.missing += missing;
    const std::size_t non_finite = values.size() - kept - missing;
    tally.non_finite += non_finite;
    row.non_finite = non_finite > 0 ? 1 : 0;
    if (kept == 0) return;
    count_values(std::span(finite.data(), kept), 1, row, tally);
    if (widths_) summarize_widths(std::span(finite.data(), kept), false, row);
  }

  const NodeLattice& leaves_;
  const ValueTable& table_;
  bool widths_;
  const std::optional<LadderAim>& aim_;
  const BlockSample& sample_;
  Counting counting_;
  bool has_missing_;
  LeafCache* cache_;  // null if nothing is cached
  const Block& block_;
  const Box& leaf_box_;
  std::span<LeafRow> rows_;
  std::span<LeafFaces> faces_;
  std::span<PackedLadder> ladders_;
};

BlockSurvey::BlockSurvey(const SourceInfo& info, RowStore& rows, LeafStore<LeafFaces>* faces, bool widths, Trace* trace,
                         const std::optional<LadderAim>& ladders, Counting counting)
    : rows_(rows),
      faces_(faces),
      widths_(widths),
      ladders_(ladders),
      sample_(rows.leaves()),
      counting_(counting),
      has_missing_(info.mapping.marks_missing()),
      trace_(trace),
      table_(value_table(info)),
      fresh_([this] {
        Tally fresh;
        fresh.value_counts.resize(table_.size);
        return fresh;
      }()),
      tallies_(fresh_) {}

void BlockSurvey::add(const Block& block, const Box& leaf_box, Sharing sharing) {
  const Index3 extent = leaf_box.extent();
  std::vector<LeafRow> block_rows(static_cast<std::size_t>(volume(extent)));
  std::vector<LeafFaces> block_faces(faces_ == nullptr ? 0 : block_rows.size());
  std::vector<PackedLadder> block_ladders(ladders_ ? block_rows.size() : 0);
  // A coder looks at the blocks while this function makes their rows.
  std::unique_ptr<LoadedBlocks> loaded;
  BlockCoder* const coder = ladders_ ? ladders_->surveying_coder() : nullptr;
  if (coder != nullptr && !holds_one_value(block.values)) {  // empty space is not worth the transfer
    const NodeLattice& lattice = rows_.leaves();
    loaded = coder->load(block.values, block.voxels, lattice.nodes_box(leaf_box));
    if (loaded) loaded->begin_survey(ladders_->rung_ask());
  }
  const Leaves leaves(*this, block, leaf_box, block_rows, block_faces,
                      loaded ? std::span<PackedLadder>() : std::span(block_ladders));
  const auto run = [&](const auto& part) {
    const auto survey = [&](std::int64_t first, std::int64_t end) {
      const TraceSpan span(trace_, "survey");
      part(first, end, tallies_.local());
    };
    if (sharing == Sharing::alone) return survey(0, volume(extent));
    // Least leaves per task: few, because a sample's rows are short; more if leaves repeat values (kLeafLanes at once).
    const std::size_t least_run = block.parts == nullptr ? 4 : 4 * kLeafLanes;
    tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, volume(extent), least_run),
                      [&](const auto& range) { survey(range.begin(), range.end()); });
  };
  run([&](std::int64_t first, std::int64_t end, Tally& tally) { leaves.run(first, end, tally); });
  if (loaded) {
    const std::optional<SurveyedBlocks> found = loaded->end_survey();
    run([&](std::int64_t first, std::int64_t end, Tally& tally) {
      leaves.run_ladders(first, end, found, block_ladders, tally);
    });
  }
  const TraceSpan span(trace_, "write", std::span(block_rows).size_bytes());
  rows_.write_box(leaf_box, block_rows);
  if (faces_ != nullptr) faces_->write_box(leaf_box, block_faces);
  if (ladders_) rows_.ladders()->write_box(leaf_box, block_ladders);
  tallies_.local().loss.add(block.loss);
}

bool BlockSurvey::take(const SurveyedBlock& found, const BlockSummary& summary, bool sampled, Tally& tally,
                       LeafRow& row, PackedLadder& ladder) const {
  if (summary.finite < kLeafVoxels) return false;
  row = {};
  static_cast<BlockSummary&>(row) = summary;
  if (row.uniform()) {
    ladder = LadderBuilder::uniform();
  } else {
    const NearRungs near = ladders_->near_for(row, sampled);
    const auto built = tally.builder(*ladders_).build_from(found, row, near);
    if (!built) return false;
    ladder = *built;
  }
  tally.finite += row.finite;
  tally.min = std::min(tally.min, row.min);
  tally.max = std::max(tally.max, row.max);
  return true;
}

std::vector<std::uint32_t> BlockSurvey::take(const SurveyedBlocks& found, std::span<const Box> parts, Taken taken) {
  const NodeLattice& lattice = rows_.leaves();
  const Index3 extent = parts.front().extent();
  // A run is the part of a line along x in which the sample has all leaves or none.
  const std::int64_t length = sample_.row_length();
  const Index3 runs{ceil_div(extent.x, length) + 1, extent.y, extent.z};  // one more, as a box may begin within a run
  const std::int64_t all_runs = volume(runs) * std::ssize(parts);
  tbb::enumerable_thread_specific<std::vector<std::uint32_t>> left;
  tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, all_runs, 8), [&](const auto& range) {
    const TraceSpan span(trace_, "survey");
    std::array<LeafRow, BlockSample::kLongestRow> rows;
    std::array<PackedLadder, BlockSample::kLongestRow> ladders;
    Tally& tally = tallies_.local();
    for (std::int64_t run = range.begin(); run < range.end(); ++run) {
      const Box& part = parts[static_cast<std::size_t>(run / volume(runs))];
      const Index3 place = index_at(run % volume(runs), runs);
      Index3 first = part.lo + Index3{0, place.y, place.z};
      const std::int64_t begin_x = (part.lo.x / length + place.x) * length;
      const std::int64_t end_x = std::min(begin_x + length, part.hi.x);
      first.x = std::max(begin_x, first.x);
      if (first.x >= end_x) continue;
      const bool sampled = sample_.has(first);
      if (sampled && taken == Taken::unsampled) continue;
      const auto count = static_cast<std::size_t>(end_x - first.x);
      const std::int64_t before = run / volume(runs) * volume(extent);
      const auto begin = static_cast<std::size_t>(before + linear_index(first - part.lo, extent));
      for (std::size_t i = 0; i < count; ++i) {
        const Index3 leaf = first + Index3{static_cast<std::int64_t>(i), 0, 0};
        const std::size_t at = begin + i;
        const bool whole = lattice.voxels(leaf).voxels() == kLeafVoxels;
        if (whole && take(found.block(at), found.summaries[at], sampled, tally, rows[i], ladders[i])) continue;
        left.local().push_back(static_cast<std::uint32_t>(at));
      }
      const std::int64_t linear = lattice.linear(first);
      rows_.write(linear, std::span(rows).first(count));
      rows_.ladders()->write(linear, std::span(ladders).first(count));
    }
  });
  std::vector<std::uint32_t> all;
  for (const std::vector<std::uint32_t>& some : left) all.insert(all.end(), some.begin(), some.end());
  return all;
}

void BlockSurvey::survey_left(const Index3& leaf, const float* block) {
  const NodeLattice& lattice = rows_.leaves();
  const Box leaf_box{leaf, leaf + Index3{1, 1, 1}};
  const Box inside = lattice.voxels(leaf);
  LeafValues own;
  const Block alone{0, inside, in_domain_values(block, lattice.node_box(leaf), inside, own), {}};
  LeafRow row;
  PackedLadder ladder;
  const Leaves one(*this, alone, leaf_box, {&row, 1}, {}, {&ladder, 1});
  one.run(0, 1, tallies_.local());
  rows_.write(lattice.linear(leaf), {&row, 1});
  rows_.ladders()->write(lattice.linear(leaf), {&ladder, 1});
}

SurveyTally BlockSurvey::tally() const {
  SurveyTally sum = fresh_;
  for (const Tally& tally : tallies_) sum.merge(tally);
  return sum;
}

Survey BlockSurvey::result(const SurveyTally& tally) const {
  const NodeLattice& leaves = rows_.leaves();
  Survey survey;
  survey.loss = tally.loss;
  survey.finite = tally.finite;
  survey.missing = tally.missing;
  survey.non_finite = tally.non_finite;
  if (tally.finite > 0) {
    survey.min = tally.min;
    survey.max = tally.max;
  }
  if (tally.non_finite > 0) {
    survey.first_non_finite = leaves.domain.lo + index_at(tally.first_non_finite, leaves.domain.extent());
    survey.first_non_finite_value = tally.first_non_finite_value;
  }
  if (tally.missing > 0) {
    survey.first_missing = leaves.domain.lo + index_at(tally.first_missing, leaves.domain.extent());
  }
  survey.histogram = tally.histogram;
  survey.value_counts = tally.value_counts;
  survey.value_offset = table_.offset;
  for (std::size_t i = 0; i < survey.value_counts.size(); ++i) {
    survey.histogram.add(static_cast<float>(table_.offset + static_cast<int>(i)), survey.value_counts[i]);
  }
  return survey;
}

}  // namespace weir
