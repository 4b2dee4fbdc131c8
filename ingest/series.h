// Several volumes asked for at once: the steps of a time series, each of them
// one file, one dataset or one position on a leading axis.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "format/base/message.h"
#include "ingest/source/source_options.h"

namespace weir {

/// One volume: what to open, and what to name its file after.
struct SeriesStep {
  std::string path;
  std::string dataset;
  std::vector<std::int64_t> index;
  /// {stem}: the path's last part without its suffix, and without the number of a stack; of a directory, its name.
  std::string stem;
  std::string step;  ///< {step}: running numbers, padded with zeros so that names sort; empty for a single volume
  std::string series = {};  ///< the same for the steps of one series: name or numbered pattern of their dataset
  std::optional<std::int64_t> level = {};        ///< of Levels::separate: the one that it is, 0 the coarsest
  std::optional<std::int64_t> from_finest = {};  ///< the same level, counted from the finest that is read
};

/// The volumes that `inputs` and `options` name, in the order of the inputs, then of the datasets, then by rising
/// number. An input that is no file and has *, ? or [...], or one %d or %05d in its last part, stands for all files of
/// such names (unless options.stack takes it as one volume). options.dataset has a name on each line; one with %d, or
/// *, ? or [...], which match slashes, too, stands for all datasets of such names, of the second kind those that are
/// volumes with these options; `notice` gets a line for each other (dataset_pattern.h). options.index_choices become
/// positions; with Levels::separate each level of a file is a volume, the finest first. Throws Error(usage) where a
/// pattern is used on a format that has no datasets, or on an unclear dataset, and what chosen_positions and
/// matching_datasets throw; Error(input) where nothing matches or a file cannot be listed.
std::vector<SeriesStep> expand_series(std::span<const std::string> inputs, const SourceOptions& options,
                                      const Notice& notice = {});

/// `options` for the one volume `step` of what they name.
SourceOptions options_of_step(const SourceOptions& options, const SeriesStep& step);

}  // namespace weir
