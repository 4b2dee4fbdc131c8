#include "compressor/survey.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <cstring>

#include "compressor/leaf_summary.h"
#include "format/digest.h"

namespace weir {
namespace {

// Smallest value and number of values of an 8- or 16-bit integer type; zero values where they are scaled, and for
// wider types.
struct ValueTable {
  int offset = 0;
  std::size_t size = 0;
};

ValueTable value_table(const SourceInfo& info) {
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

// What one thread has seen.
struct Tally : SurveyTally {
  UniformDigest uniform;
};

// Surveys the leaves of one block.
class BlockSurvey {
 public:
  // `faces` is empty where they are not asked for.
  BlockSurvey(const NodeLattice& leaves, const ValueTable& table, bool widths, const Block& block, const Box& leaf_box,
              std::span<LeafRow> rows, std::span<LeafFaces> faces)
      : leaves_(leaves),
        table_(table),
        widths_(widths),
        block_(block),
        leaf_box_(leaf_box),
        rows_(rows),
        faces_(faces) {}

  // All leaves of one row along x; `row` is relative to the block.
  void leaf_row(std::int64_t y, std::int64_t z, Tally& tally) const {
    const Index3 extent = leaf_box_.extent();
    for (std::int64_t x = 0; x < extent.x; ++x) {
      const Index3 leaf = leaf_box_.lo + Index3{x, y, z};
      const auto at = static_cast<std::size_t>(linear_index({x, y, z}, extent));
      rows_[at] = survey_leaf(leaf, faces_.empty() ? nullptr : &faces_[at], tally);
    }
  }

 private:
  LeafRow survey_leaf(const Index3& leaf, LeafFaces* faces, Tally& tally) const {
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
    tally.finite += row.finite;
    if (row.finite == count) {
      count_values(seen, row, tally);
      if (widths_) summarize_widths(seen, true, row);
    } else {
      count_non_finite(seen, inside, row, tally);
    }
    return row;
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
      if (is_missing(values[i])) {
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
  const Block& block_;
  const Box& leaf_box_;
  std::span<LeafRow> rows_;
  std::span<LeafFaces> faces_;
};

}  // namespace

Survey survey_volume(VolumeSource& source, const BlockPlan& plan, RowStore& rows, const StreamOptions& options,
                     Reading reading, bool widths, LeafStore<LeafFaces>* faces, SurveyState* state,
                     const Pauses& pauses) {
  const NodeLattice& leaves = plan.lattice;
  const ValueTable table = value_table(source.info());
  Tally fresh;
  fresh.value_counts.resize(table.size);
  tbb::enumerable_thread_specific<Tally> tallies(fresh);
  SurveyState from_nothing;
  SurveyState& known = state == nullptr ? from_nothing : *state;
  const SurveyTally before = known.tally;
  const auto total = [&] {
    SurveyTally sum = before;
    sum.merge(fresh);
    for (const Tally& tally : tallies) sum.merge(tally);
    return sum;
  };

  std::vector<Box> leaf_boxes;
  for (std::int64_t i = 0; i < plan.size(); ++i) {
    for (const Box& part : known.done.missing_from(plan.leaf_box(i))) leaf_boxes.push_back(part);
  }
  std::vector<Box> boxes;
  boxes.reserve(leaf_boxes.size());
  for (const Box& box : leaf_boxes) boxes.push_back(plan.voxel_box(box));

  StreamOptions stream = options;
  std::size_t told = 0;
  const auto tell = [&](std::size_t boxes_done) {
    for (; told < boxes_done; ++told) known.done.add(leaf_boxes[told]);
    known.tally = total();
  };
  if (pauses.due) {
    stream.at_rest = [&](std::size_t boxes_done) {
      if (!pauses.due()) return;
      tell(boxes_done);
      pauses.save();
    };
  }
  const auto survey_block = [&](const Block& block, const auto& for_rows) {
    const Box& leaf_box = leaf_boxes[block.index];
    const Index3 extent = leaf_box.extent();
    std::vector<LeafRow> block_rows(static_cast<std::size_t>(volume(extent)));
    std::vector<LeafFaces> block_faces(faces == nullptr ? 0 : block_rows.size());
    const BlockSurvey work(leaves, table, widths, block, leaf_box, block_rows, block_faces);
    for_rows(extent.y * extent.z,
             [&](std::int64_t row, Tally& tally) { work.leaf_row(row % extent.y, row / extent.y, tally); });
    const TraceSpan span(options.trace, "write", std::span(block_rows).size_bytes());
    rows.write_box(leaf_box, block_rows);
    if (faces != nullptr) faces->write_box(leaf_box, block_faces);
    tallies.local().loss.add(block.loss);
  };
  if (reading == Reading::in_place) {
    work_in_place(source, boxes, stream, [&](const Block& block) {
      survey_block(block, [&](std::int64_t count, const auto& on_row) {
        const TraceSpan span(options.trace, "survey");
        Tally& tally = tallies.local();
        for (std::int64_t row = 0; row < count; ++row) on_row(row, tally);
      });
    });
  } else {
    stream_blocks(source, boxes, stream, [&](const Block& block) {
      survey_block(block, [&](std::int64_t count, const auto& on_row) {
        tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, count), [&](const auto& range) {
          const TraceSpan span(options.trace, "survey");
          Tally& tally = tallies.local();
          for (std::int64_t row = range.begin(); row < range.end(); ++row) on_row(row, tally);
        });
      });
    });
  }
  tell(boxes.size());

  const SurveyTally& counted = known.tally;
  Survey survey;
  survey.loss = counted.loss;
  survey.finite = counted.finite;
  survey.missing = counted.missing;
  survey.non_finite = counted.non_finite;
  if (counted.finite > 0) {
    survey.min = counted.min;
    survey.max = counted.max;
  }
  if (counted.non_finite > 0) {
    survey.first_non_finite = leaves.domain.lo + index_at(counted.first_non_finite, leaves.domain.extent());
    survey.first_non_finite_value = counted.first_non_finite_value;
  }
  survey.histogram = counted.histogram;
  survey.value_counts = counted.value_counts;
  survey.value_offset = table.offset;
  for (std::size_t i = 0; i < survey.value_counts.size(); ++i) {
    survey.histogram.add(static_cast<float>(table.offset + static_cast<int>(i)), survey.value_counts[i]);
  }
  return survey;
}

std::string source_digest(const RowStore& rows) {
  constexpr std::int64_t kPiece = 4096;
  DigestStream digest;
  std::vector<LeafRow> piece;
  const std::int64_t total = rows.leaves().size();
  for (std::int64_t first = 0; first < total; first += kPiece) {
    piece.resize(static_cast<std::size_t>(std::min(kPiece, total - first)));
    rows.read(first, piece);
    for (const LeafRow& row : piece) digest.update(row.digest);
  }
  return digest.digest().hex();
}

}  // namespace weir
