#include "compressor/survey/resident_survey.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

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
#include "format/process/process_memory.h"

namespace weir {
namespace {

// The most blocks, in rows along x, that the device looks at together. Its findings take at most 6 MiB.
constexpr std::int64_t kMostBlocks = 8192;
// The most blocks that the device leaves to the host and copies to it together.
constexpr std::size_t kMostLeft = 4096;

// Returns boxes of lattice positions that together cover a lattice of `count`: whole rows, or parts of a row.
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
  // A box that the device works on. Objects are reused to keep their memory.
  struct Begun {
    Box leaf_box;
    std::unique_ptr<ResidentBlocks> blocks{};  // null: the host reads the box from the source
    std::vector<float> read{};                 // values of leaves that the device cannot copy to the host

    Index3 leaf(std::size_t at) const {
      return leaf_box.lo + index_at(static_cast<std::int64_t>(at), leaf_box.extent());
    }
  };

  void begin(const Box& box, Begun& begun) {
    throw_if_cancelled(options_);
    begun.leaf_box = box;
    begun.blocks = resident_.open(leaves_.nodes_box(box));
    if (begun.blocks) begun.blocks->begin_survey(ask_);
  }

  void end(Begun& begun) {
    const Box& box = begun.leaf_box;
    if (const auto found = begun.blocks ? begun.blocks->end_survey() : std::nullopt) {
      const std::vector<std::uint32_t> all_left = survey_.take(*found, box);
      const std::span<const std::uint32_t> left(all_left);
      for (std::size_t at = 0; at < left.size(); at += kMostLeft) {
        survey_left(begun, left.subspan(at, std::min(kMostLeft, left.size() - at)));
      }
    } else {
      survey_read(box);
    }
    begun.blocks.reset();
    const std::lock_guard lock(progress_);
    done_ += leaves_.voxels(box).voxels();
    if (options_.progress) options_.progress(done_, leaves_.domain.voxels());
  }

  void survey_left(Begun& begun, std::span<const std::uint32_t> left) {
    const std::span<const float> values = values_of(begun, left);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, left.size(), 16), [&](const auto& range) {
      const TraceSpan span(options_.trace, "survey");
      for (std::size_t k = range.begin(); k < range.end(); ++k) {
        survey_.survey_left(begun.leaf(left[k]), values.data() + kLeafVoxels * k);
      }
    });
  }

  std::span<const float> values_of(Begun& begun, std::span<const std::uint32_t> left) {
    const TraceSpan span(options_.trace, "read", kLeafVoxels * sizeof(float) * left.size());
    if (const auto values = begun.blocks->values(left)) return *values;
    begun.read.resize(kLeafVoxels * left.size());
    std::vector<Index3> leaves;
    for (const std::uint32_t at : left) leaves.push_back(begun.leaf(at));
    read_blocks(source_, leaves_, begun.leaf_box, leaves, begun.read);
    return begun.read;
  }

  void survey_read(const Box& leaf_box) {
    const Box voxels = leaves_.voxels(leaf_box);
    std::vector<float> values(static_cast<std::size_t>(voxels.voxels()));
    const ConversionLoss loss = source_.read(voxels, values);
    survey_.add({0, voxels, values, loss}, leaf_box, BlockSurvey::Sharing::shared);
  }

  // Counts all finite values in the histogram bins of the final range, which is known only now.
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

// Makes the memory pages of the rows and ladders, if these lie in memory. A sample has rows in nearly every page, so
// that its survey would wait for each page.
void make_pages_of(RowStore& rows, tbb::task_group& tasks) {
  for (File* const file : {&rows.file(), &rows.ladders()->file()}) {
    const std::span<const std::byte> all = file->memory();
    constexpr std::size_t kPiece = std::size_t{16} << 20U;
    for (std::size_t at = 0; at < all.size(); at += kPiece) {
      tasks.run([part = all.subspan(at, std::min(kPiece, all.size() - at))] { make_pages(part); });
    }
  }
}

}  // namespace

Survey survey_resident(ResidentVolume& resident, VolumeSource& source, RowStore& rows, const LadderAim& ladders,
                       const StreamOptions& options) {
  return ResidentSurvey(resident, source, rows, ladders, ladders.rung_ask(), options).run();
}

void survey_resident_sample(ResidentVolume& resident, VolumeSource& source, RowStore& rows, const LadderAim& ladders,
                            std::span<const Box> boxes, const StreamOptions& options) {
  RungAsk ask = ladders.rung_ask();
  if (ladders.near_rungs) ask.near.blocks = NearBlocks::all;
  tbb::task_group pages;
  make_pages_of(rows, pages);
  ResidentSurvey(resident, source, rows, ladders, ask, options).add(boxes);
  pages.wait();
}

}  // namespace weir
