#include "compressor/survey/resident_survey.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "compressor/packed/block_sample.h"
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

// Returns groups of at most kMostBlocks blocks, each of rows of one length.
std::vector<std::vector<Box>> equal_rows(std::span<const Box> rows) {
  std::map<std::int64_t, std::vector<std::vector<Box>>> groups;  // by length
  for (const Box& row : rows) {
    const std::int64_t length = row.extent().x;
    std::vector<std::vector<Box>>& of_length = groups[length];
    if (of_length.empty() || (std::ssize(of_length.back()) + 1) * length > kMostBlocks) of_length.emplace_back();
    of_length.back().push_back(row);
  }
  std::vector<std::vector<Box>> all;
  for (auto& [length, of_length] : groups) std::ranges::move(of_length, std::back_inserter(all));
  return all;
}

class ResidentSurvey {
 public:
  ResidentSurvey(ResidentVolume& resident, VolumeSource& source, RowStore& rows, const LadderAim& ladders,
                 const StreamOptions& options)
      : resident_(resident),
        source_(source),
        leaves_(rows.leaves()),
        sample_(leaves_),
        ask_(ladders.rung_ask()),
        sample_ask_(ask_),
        options_(options),
        survey_(source.info(), rows, nullptr, false, options.trace, ladders, BlockSurvey::Counting::elsewhere) {
    if (ladders.near_rungs) sample_ask_.near.blocks = NearBlocks::all;
  }

  void add_sampled(std::span<const Box> rows) {
    std::vector<Task> tasks;
    add_tasks(rows, tasks);
    add(tasks);
  }

  Survey run() {
    std::vector<Task> tasks;
    // Sampled blocks have near rungs in any case. If other blocks have none, or only some do, the device looks at the
    // sampled ones apart.
    const bool differ = sample_ask_.near.blocks != ask_.near.blocks;
    const bool apart = differ && sample_.size() <= leaves_.size() / 8;
    if (apart) add_tasks(sample_.rows(), tasks);
    for (const Box& box : leaf_boxes(leaves_.count)) {
      tasks.push_back({{box},
                       apart ? ask_ : sample_ask_,
                       apart ? BlockSurvey::Taken::unsampled : BlockSurvey::Taken::all,
                       leaves_.voxels(box).voxels()});
    }
    add(tasks);
    count();
    return survey_.result(survey_.tally());
  }

 private:
  // Blocks that the device looks at together: a box of lattice positions, or rows of one length along x.
  struct Task {
    std::vector<Box> parts;
    RungAsk ask;
    BlockSurvey::Taken taken;
    std::int64_t voxels = 0;  // of the progress; 0 for rows, whose voxels are counted with their boxes

    Index3 leaf(std::size_t number) const {
      const Index3 extent = parts.front().extent();
      const auto at = static_cast<std::int64_t>(number);
      const Box& part = parts[static_cast<std::size_t>(at / volume(extent))];
      return part.lo + index_at(at % volume(extent), extent);
    }
  };
  // A task that the device works on. Objects are reused to keep their memory.
  struct Begun {
    const Task* task = nullptr;
    std::unique_ptr<ResidentBlocks> blocks{};  // null: the host reads the blocks from the source
    std::vector<float> read{};                 // values of leaves that the device cannot copy to the host
  };

  void add_tasks(std::span<const Box> rows, std::vector<Task>& tasks) const {
    for (std::vector<Box>& parts : equal_rows(rows)) {
      tasks.push_back({std::move(parts), sample_ask_, BlockSurvey::Taken::all});
    }
  }

  void add(std::span<const Task> tasks) {
    one_ahead<Begun>(
        tasks.size(), resident_.most_open(), [&](std::size_t i, Begun& begun) { begin(tasks[i], begun); },
        [&](Begun& begun) { end(begun); });
  }

  void begin(const Task& task, Begun& begun) {
    throw_if_cancelled(options_);
    begun.task = &task;
    if (task.parts.size() == 1) {
      begun.blocks = resident_.open(leaves_.nodes_box(task.parts.front()));
    } else {
      std::vector<Box> rows;
      for (const Box& part : task.parts) rows.push_back(leaves_.nodes_box(part));
      begun.blocks = resident_.open_rows(rows);
    }
    if (begun.blocks) begun.blocks->begin_survey(task.ask);
  }

  void end(Begun& begun) {
    const Task& task = *begun.task;
    if (const auto found = begun.blocks ? begun.blocks->end_survey() : std::nullopt) {
      const std::vector<std::uint32_t> all_left = survey_.take(*found, task.parts, task.taken);
      const std::span<const std::uint32_t> left(all_left);
      for (std::size_t at = 0; at < left.size(); at += kMostLeft) {
        survey_left(begun, left.subspan(at, std::min(kMostLeft, left.size() - at)));
      }
    } else {
      for (const Box& part : task.parts) survey_read(part, task.taken);
    }
    begun.blocks.reset();
    const std::lock_guard lock(progress_);
    done_ += task.voxels;
    if (options_.progress) options_.progress(done_, leaves_.domain.voxels());
  }

  void survey_left(Begun& begun, std::span<const std::uint32_t> left) {
    const std::span<const float> values = values_of(begun, left);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, left.size(), 16), [&](const auto& range) {
      const TraceSpan span(options_.trace, "survey");
      for (std::size_t k = range.begin(); k < range.end(); ++k) {
        survey_.survey_left(begun.task->leaf(left[k]), values.data() + kLeafVoxels * k);
      }
    });
  }

  std::span<const float> values_of(Begun& begun, std::span<const std::uint32_t> left) {
    const TraceSpan span(options_.trace, "read", kLeafVoxels * sizeof(float) * left.size());
    if (const auto values = begun.blocks->values(left)) return *values;
    const Task& task = *begun.task;
    begun.read.resize(kLeafVoxels * left.size());
    std::vector<Index3> leaves;
    for (const std::uint32_t number : left) leaves.push_back(task.leaf(number));
    if (task.parts.size() == 1) {
      read_blocks(source_, leaves_, task.parts.front(), leaves, begun.read);
      return begun.read;
    }
    for (std::size_t k = 0; k < leaves.size(); ++k) {
      const Box alone{leaves[k], leaves[k] + Index3{1, 1, 1}};
      const std::span<float> values = std::span(begun.read).subspan(kLeafVoxels * k, kLeafVoxels);
      read_blocks(source_, leaves_, alone, std::span(leaves).subspan(k, 1), values);
    }
    return begun.read;
  }

  void survey_read(const Box& leaf_box, BlockSurvey::Taken taken) {
    const Box voxels = leaves_.voxels(leaf_box);
    std::vector<float> values(static_cast<std::size_t>(voxels.voxels()));
    const ConversionLoss loss = source_.read(voxels, values);
    if (taken == BlockSurvey::Taken::all) {
      return survey_.add({0, voxels, values, loss}, leaf_box, BlockSurvey::Sharing::shared);
    }
    std::vector<Box> unsampled;  // runs along x
    for_each_index(leaf_box, [&](const Index3& leaf) {
      if (sample_.has(leaf)) return;
      const Index3 end = leaf + Index3{1, 1, 1};
      const bool goes_on = !unsampled.empty() && unsampled.back().hi == Index3{leaf.x, end.y, end.z};
      if (goes_on) {
        unsampled.back().hi.x = end.x;
      } else {
        unsampled.push_back({leaf, end});
      }
    });
    tbb::parallel_for(std::size_t{0}, unsampled.size(), [&](std::size_t i) {
      survey_.add({0, voxels, values, i == 0 ? loss : ConversionLoss{}}, unsampled[i], BlockSurvey::Sharing::alone);
    });
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
  const BlockSample sample_;
  const RungAsk ask_;
  RungAsk sample_ask_;
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
  return ResidentSurvey(resident, source, rows, ladders, options).run();
}

void survey_resident_sample(ResidentVolume& resident, VolumeSource& source, RowStore& rows, const LadderAim& ladders,
                            std::span<const Box> boxes, const StreamOptions& options) {
  tbb::task_group pages;
  make_pages_of(rows, pages);
  ResidentSurvey(resident, source, rows, ladders, options).add_sampled(boxes);
  pages.wait();
}

}  // namespace weir
