// What is refused of several volumes that are converted in one call.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>

#include "compressor/conversion_options.h"
#include "ingest/series.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// What would be refused after minutes of work, before it: of several outputs one that exists too, unless `may_exist`.
/// Throws Error(usage) as check_output does, and where an output is another step's input.
void check_outputs(std::span<const SeriesStep> steps, std::span<const std::string> outputs, bool may_exist);

/// A player has two buffers of one size for all steps of a series (SeriesStep::series). Volumes of different series, as
/// the datasets of '*', may differ; and so may all where no budget was asked for.
class SeriesExtents {
 public:
  explicit SeriesExtents(const Budget& budget) : by_extent_(budget.kind == Budget::Kind::rate) {}

  /// Throws Error(input) where the budget is a rate, which gives `info`, the source of `step`, another size of file
  /// than the first one of its series had.
  void check(const SeriesStep& step, const SourceInfo& info);

  /// The same of all `steps`, before any of them is converted, where `open`ing their files takes no work.
  void check_all(std::span<const SeriesStep> steps,
                 const std::function<std::unique_ptr<VolumeSource>(const SeriesStep&)>& open);

 private:
  struct First {
    std::string place;  ///< path and dataset
    Index3 extent;
  };

  bool by_extent_;
  std::map<std::string, First> first_;  ///< of each series
};

}  // namespace weir
