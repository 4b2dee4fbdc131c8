// The volumes of one call, for instance the steps of a time series. Each step is one file, one dataset or one
// position on a leading axis.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "format/base/message.h"
#include "ingest/source/source_options.h"

namespace weir {

/// One volume: what to open, and the words that name its output file.
struct SeriesStep {
  std::string path;
  std::string dataset;
  std::vector<std::int64_t> index;
  /// {stem}: the last part of the path, without its suffix and without the number of a stack; for a directory, its
  /// name
  std::string stem;
  std::string step;  ///< {step}: running numbers, padded with zeros so that names sort; empty for a single volume
  std::string series = {};  ///< equal for all steps of one series: the name or numbered pattern of their dataset
  std::optional<std::int64_t> level = {};        ///< with Levels::separate: the level of this step, 0 is the coarsest
  std::optional<std::int64_t> from_finest = {};  ///< the same level, counted from the finest level that is read
};

/// Returns the volumes that `inputs` and `options` name, ordered by input, then by dataset, then by rising number. An
/// input that is no existing file stands for all files that match its *, ? or [...], or one %d or %05d in its last
/// part (unless options.stack takes it as one volume). options.dataset holds one name per line. A name with %d stands
/// for all datasets that match it. A name with *, ? or [...], which also match slashes, stands for all matching
/// datasets that are volumes with these options; `notice` gets a line for each other match (dataset_pattern.h).
/// options.index_choices become positions. With Levels::separate each level of a file is a volume, the finest first.
/// Throws Error(usage) if a pattern is used on a format without datasets or if the dataset is unclear, and what
/// chosen_positions and matching_datasets throw. Throws Error(input) if nothing matches or a file cannot be listed.
std::vector<SeriesStep> expand_series(std::span<const std::string> inputs, const SourceOptions& options,
                                      const Notice& notice = {});

/// Returns `options` changed to name only the volume of `step`.
SourceOptions options_of_step(const SourceOptions& options, const SeriesStep& step);

}  // namespace weir
