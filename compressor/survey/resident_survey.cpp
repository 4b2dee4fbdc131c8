#include "compressor/survey/resident_survey.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "compressor/packed/block_values.h"
#include "compressor/survey/one_ahead.h"

namespace weir {
namespace {

// Blocks that the device looks at together, in rows along x: what it finds of them is at most 5 MiB.
constexpr std::int64_t kMostBlocks = 4096;

// Boxes of lattice positions that cover all of it: rows, or parts of one.
std::vector<Box> leaf_boxes(const Index3& count) {
  const std::int64_t x_most = std::min(count.x, kMostBlocks);
  const std::int64_t y_most = std::clamp<std::int64_t>(kMostBlocks / x_most, 1, count.y);
  const Index3 most{x_most, y_most, std::clamp<std::int64_t>(kMostBlocks / (x_most * y_most), 1, count.z)};
  std::vector<Box> boxes;
  for (std::int64_t z = 0; z < count.z; z += most.z) {
    for (std::int64_t y = 0; y < count.y; y += most.y) {
      for (std::int64_t x = 0; x < count.x; x += most.x) {
        const Index3 lo{x, y, z};
        boxes.push_back({lo, min(lo + most, count)});
      }
    }
  }
  return boxes;
}

class ResidentSurvey {
 public:
  ResidentSurvey(ResidentVolume& resident, VolumeSource& source, RowStore& rows, const LadderAim& ladders,
                 const RungAsk& ask, const StreamOptions& options)
      : resident_(resident),
        source_(source),
        leaves_(rows.leaves()),
        ask_(ask),
        options_(options),
        survey_(source.info(), rows, nullptr, false, options.trace, ladders, BlockSurvey::Counting::elsewhere) {}

  void add(std::span<const Box> boxes) {
    one_ahead<Begun>(
        boxes.size(), resident_.most_open(), [&](std::size_t i, Begun& begun) { begin(boxes[i], begun); },
        [&](Begun& begun) { end(begun); });
  }

  Survey run() {
    add(leaf_boxes(leaves_.count));
    count();
    return survey_.result(survey_.tally());
  }

 private:
  // A box that the device works on, and what is kept of it. Used again, for the memory that it has.
  struct Begun {
    BlockSurvey::FoundLeaves leaves{};
    std::unique_ptr<ResidentBlocks> blocks{};  // null: to be read
    std::span<const float> left{};             // values of the leaves that are left
    std::vector<float> read{};                 // where the device does not give them
  };

  void begin(const Box& box, Begun& begun) {
    throw_if_cancelled(options_);
    begun.leaves.begin(box);
    begun.blocks = resident_.open(leaves_.nodes_box(box));
    if (begun.blocks) begun.blocks->begin_survey(ask_);
  }

  void end(Begun& begun) {
    const Box& box = begun.leaves.leaf_box;
    if (const auto found = begun.blocks ? begun.blocks->end_survey() : std::nullopt) {
      survey_.take(*found, begun.leaves);
      get_left(begun);
      survey_left(begun);
      survey_.write(begun.leaves);
    } else {
      survey_read(box);
    }
    begun.blocks.reset();
    const std::lock_guard lock(progress_);
    done_ += leaves_.voxels(box).voxels();
    if (options_.progress) options_.progress(done_, leaves_.domain.voxels());
  }

  void survey_left(Begun& begun) {
    const std::vector<std::uint32_t>& left = begun.leaves.left;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, left.size(), 16), [&](const auto& range) {
      const TraceSpan span(options_.trace, "survey");
      for (std::size_t k = range.begin(); k < range.end(); ++k) {
        survey_.survey_left(begun.leaves, left[k], begun.left.data() + kLeafVoxels * k);
      }
    });
  }

  void get_left(Begun& begun) {
    const std::vector<std::uint32_t>& left = begun.leaves.left;
    if (left.empty()) return;
    const TraceSpan span(options_.trace, "read", kLeafVoxels * sizeof(float) * left.size());
    if (const auto values = begun.blocks->values(left)) {
      begun.left = *values;
      return;
    }
    begun.read.resize(kLeafVoxels * left.size());
    std::vector<Index3> leaves;
    for (const std::uint32_t at : left) leaves.push_back(begun.leaves.leaf(at));
    read_blocks(source_, leaves_, begun.leaves.leaf_box, leaves, begun.read);
    begun.left = begun.read;
  }

  void survey_read(const Box& leaf_box) {
    const Box voxels = leaves_.voxels(leaf_box);
    std::vector<float> values(static_cast<std::size_t>(voxels.voxels()));
    const ConversionLoss loss = source_.read(voxels, values);
    survey_.add({0, voxels, values, loss}, leaf_box, BlockSurvey::Sharing::shared);
  }

  // By the bins that the volume's range has in the end.
  void count() {
    const SurveyTally tally = survey_.tally();
    if (tally.finite == 0) return;
    RangeHistogram range;
    range.add(tally.min, 1);
    range.add(tally.max, 1);
    const std::size_t bins = range.counts().size();
    if (const auto counts = resident_.count(range.exponent(), range.base(), bins)) {
      survey_.add_counts(RangeHistogram::restored(range.exponent(), range.base(), *counts));
      return;
    }
    std::vector<std::uint64_t> counts(bins);
    std::vector<float> values;
    for (const Box& leaf_box : leaf_boxes(leaves_.count)) {
      throw_if_cancelled(options_);
      const Box voxels = leaves_.voxels(leaf_box);
      values.resize(static_cast<std::size_t>(voxels.voxels()));
      source_.read(voxels, values);
      for (const float v : values) {
        if (std::isfinite(v)) ++counts[range.bin_of(v)];
      }
    }
    survey_.add_counts(RangeHistogram::restored(range.exponent(), range.base(), counts));
  }

  ResidentVolume& resident_;
  VolumeSource& source_;
  const NodeLattice& leaves_;
  const RungAsk ask_;
  const StreamOptions& options_;
  BlockSurvey survey_;
  std::mutex progress_;
  std::int64_t done_ = 0;
};

}  // namespace

Survey survey_resident(ResidentVolume& resident, VolumeSource& source, RowStore& rows, const LadderAim& ladders,
                       const StreamOptions& options) {
  return ResidentSurvey(resident, source, rows, ladders, ladders.rung_ask(), options).run();
}

void survey_resident_sample(ResidentVolume& resident, VolumeSource& source, RowStore& rows, const LadderAim& ladders,
                            std::span<const Box> boxes, const StreamOptions& options) {
  RungAsk ask = ladders.rung_ask();
  if (ladders.near_rungs) ask.near.blocks = NearBlocks::all;
  ResidentSurvey(resident, source, rows, ladders, ask, options).add(boxes);
}

}  // namespace weir
