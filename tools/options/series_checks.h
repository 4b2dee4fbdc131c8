// Checks that refuse wrong inputs and outputs when several volumes are converted in one call.
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

/// Checks the outputs before the work starts, so that no error comes after minutes of work. If there are several
/// outputs, none may exist, unless `may_exist`. Throws Error(usage) as check_output does, and if an output is another
/// step's input.
void check_outputs(std::span<const SeriesStep> steps, std::span<const std::string> outputs, bool may_exist);

/// Checks that all steps of one series (SeriesStep::series) have the same extent, because a player has two buffers of
/// one size. Volumes of different series, such as the datasets of '*', may differ. Nothing is checked unless the
/// budget is a rate.
class SeriesExtents {
 public:
  explicit SeriesExtents(const Budget& budget) : by_extent_(budget.kind == Budget::Kind::rate) {}

  /// Throws Error(input) if the budget is a rate and `info`, the source of `step`, has another extent (so another file
  /// size) than the first step of its series.
  void check(const SeriesStep& step, const SourceInfo& info);

  /// Checks all `steps` before any is converted, if `open`ing their files takes no work.
  void check_all(std::span<const SeriesStep> steps,
                 const std::function<std::unique_ptr<VolumeSource>(const SeriesStep&)>& open);

 private:
  struct First {
    std::string place;  ///< path and dataset
    Index3 extent;
  };

  bool by_extent_;
  std::map<std::string, First> first_;  ///< the first step of each series
};

}  // namespace weir
