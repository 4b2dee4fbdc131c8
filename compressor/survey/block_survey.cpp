#include "compressor/survey/block_survey.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <span>
#include <vector>

#include "compressor/packed/block_values.h"
#include "compressor/packed/near_sample.h"

namespace weir {

BlockSurvey::ValueTable BlockSurvey::value_table(const SourceInfo& info) {
  if (info.mapping.scales()) return {};
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
  // `faces` and `ladders` are empty where they are not asked for.
  Leaves(const BlockSurvey& survey, const Block& block, const Box& leaf_box, std::span<LeafRow> rows,
         std::span<LeafFaces> faces, std::span<PackedLadder> ladders)
      : leaves_(survey.rows_.leaves()),
        table_(survey.table_),
        widths_(survey.widths_),
        aim_(survey.ladders_),
        has_missing_(survey.has_missing_),
        block_(block),
        leaf_box_(leaf_box),
        rows_(rows),
        faces_(faces),
        ladders_(ladders) {}

  // All leaves of one row along x; `row` is relative to the block.
  void leaf_row(std::int64_t y, std::int64_t z, Tally& tally) const {
    const Index3 extent = leaf_box_.extent();
    for (std::int64_t x = 0; x < extent.x; ++x) {
      const Index3 leaf = leaf_box_.lo + Index3{x, y, z};
      const auto at = static_cast<std::size_t>(linear_index({x, y, z}, extent));
      rows_[at] =
          survey_leaf(leaf, faces_.empty() ? nullptr : &faces_[at], ladders_.empty() ? nullptr : &ladders_[at], tally);
    }
  }

 private:
  LeafRow survey_leaf(const Index3& leaf, LeafFaces* faces, PackedLadder* ladder, Tally& tally) const {
    const Box inside = leaves_.voxels(leaf);
    const Index3 extent = inside.extent();
    const Index3 block_extent = block_.voxels.extent();
    std::array<float, kLeafVoxels> values;
    float* out = values.data();
    const float* corner = block_.values.data() + linear_index(inside.lo - block_.voxels.lo, block_extent);
    for (std::int64_t z = 0; z < extent.z; ++z) {
      for (std::int64_t y = 0; y < extent.y; ++y) {
        const float* row = corner + block_extent.x * (y + block_extent.y * z);
        if (extent.x == kLeafDim) {  // a length the compiler knows
          std::memcpy(out, row, kLeafDim * sizeof(float));
        } else {
          std::copy_n(row, extent.x, out);
        }
        out += extent.x;
      }
    }
    const auto count = static_cast<std::size_t>(volume(extent));
    const std::span<const float> seen(values.data(), count);
    LeafRow row = summarize_leaf(seen, sample_position(leaves_.linear(leaf), count), tally.uniform);
    if (faces != nullptr) *faces = faces_of(seen, extent);
    if (ladder != nullptr) *ladder = ladder_of(leaf, seen, row, tally);
    tally.finite += row.finite;
    if (row.finite == count) {
      count_values(seen, row, tally);
      if (widths_) summarize_widths(seen, true, row);
    } else {
      count_non_finite(seen, inside, row, tally);
    }
    return row;
  }

  PackedLadder ladder_of(const Index3& leaf, std::span<const float> values, const LeafRow& row, Tally& tally) const {
    const bool all = row.finite == values.size();
    if (all && row.uniform()) return LadderBuilder::uniform();
    if (!tally.ladders) tally.ladders = std::make_unique<LadderBuilder>(*aim_);
    LeafValues block;
    block_values(values, leaves_.node_box(leaf), leaves_.voxels(leaf), block);
    const bool near = aim_->near_rungs && is_near_sample(leaves_.linear(leaf), leaves_.size());
    const NearRungs rungs = near ? NearRungs::yes : NearRungs::no;
    return all ? tally.ladders->build(block, row, rungs) : tally.ladders->build_non_finite(block, row, rungs);
  }

  void count_values(std::span<const float> finite, const LeafRow& row, Tally& tally) const {
    tally.min = std::min(tally.min, row.min);
    tally.max = std::max(tally.max, row.max);
    if (table_.size > 0) {
      const auto offset = static_cast<float>(table_.offset);
      if (row.uniform()) {
        tally.value_counts[static_cast<std::size_t>(row.mean - offset)] += finite.size();
      } else {
        for (const float v : finite) ++tally.value_counts[static_cast<std::size_t>(v - offset)];
      }
    } else if (row.uniform()) {
      tally.histogram.add(row.mean, finite.size());
    } else {
      tally.histogram.add(finite, row.min, row.max);
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
      if (has_missing_ && is_missing(values[i])) {
        ++missing;
        continue;
      }
      const Index3 voxel = inside.lo + index_at(static_cast<std::int64_t>(i), extent);
      const std::int64_t at = linear_index(voxel - leaves_.domain.lo, leaves_.domain.extent());
      if (at < tally.first_non_finite) {
        tally.first_non_finite = at;
        tally.first_non_finite_value = values[i];
      }
    }
    tally.missing += missing;
    tally.non_finite += values.size() - kept - missing;
    if (kept == 0) return;
    count_values(std::span(finite.data(), kept), row, tally);
    if (widths_) summarize_widths(std::span(finite.data(), kept), false, row);
  }

  const NodeLattice& leaves_;
  const ValueTable& table_;
  bool widths_;
  const std::optional<LadderAim>& aim_;
  bool has_missing_;
  const Block& block_;
  const Box& leaf_box_;
  std::span<LeafRow> rows_;
  std::span<LeafFaces> faces_;
  std::span<PackedLadder> ladders_;
};

BlockSurvey::BlockSurvey(const SourceInfo& info, RowStore& rows, LeafStore<LeafFaces>* faces, bool widths, Trace* trace,
                         const std::optional<LadderAim>& ladders)
    : rows_(rows),
      faces_(faces),
      widths_(widths),
      ladders_(ladders),
      has_missing_(!info.mapping.missing.empty()),
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
  const Leaves leaves(*this, block, leaf_box, block_rows, block_faces, block_ladders);
  const auto survey = [&](std::int64_t first, std::int64_t end) {
    const TraceSpan span(trace_, "survey");
    Tally& tally = tallies_.local();
    for (std::int64_t row = first; row < end; ++row) leaves.leaf_row(row % extent.y, row / extent.y, tally);
  };
  const std::int64_t leaf_rows = extent.y * extent.z;
  if (sharing == Sharing::alone) {
    survey(0, leaf_rows);
  } else {
    tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, leaf_rows),
                      [&](const auto& range) { survey(range.begin(), range.end()); });
  }
  const TraceSpan span(trace_, "write", std::span(block_rows).size_bytes());
  rows_.write_box(leaf_box, block_rows);
  if (faces_ != nullptr) faces_->write_box(leaf_box, block_faces);
  if (ladders_) rows_.ladders()->write_box(leaf_box, block_ladders);
  tallies_.local().loss.add(block.loss);
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
  survey.histogram = tally.histogram;
  survey.value_counts = tally.value_counts;
  survey.value_offset = table_.offset;
  for (std::size_t i = 0; i < survey.value_counts.size(); ++i) {
    survey.histogram.add(static_cast<float>(table_.offset + static_cast<int>(i)), survey.value_counts[i]);
  }
  return survey;
}

}  // namespace weir
