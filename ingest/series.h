// Several volumes asked for at once: the steps of a time series, each of them
// one file, one dataset or one position on a leading axis.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ingest/source/source_options.h"

namespace weir {

/// In SourceOptions::index: every position of that axis, each a volume ("*" on the command line).
inline constexpr std::int64_t kEveryIndex = -1;

/// One volume: what to open, and what to name its file after.
struct SeriesStep {
  std::string path;
  std::string dataset;
  std::vector<std::int64_t> index;
  std::string stem;  ///< {stem}: the path's last part without its suffix, and without the number of a stack
  std::string step;  ///< {step}: running numbers, padded with zeros so that names sort; empty for a single volume
};

/// The volumes that `inputs` and `options` name, in the order of the inputs and then by rising number. An
/// input that is no file and has one %d or %05d in its last part stands for all files of such names (unless
/// options.stack takes it as one volume); a dataset with one stands for all datasets of such names;
/// kEveryIndex stands for each position of its axis.
/// Throws Error(usage) where a pattern is used on a format that has no datasets, or on an unclear dataset;
/// Error(input) where nothing matches or a file cannot be listed.
std::vector<SeriesStep> expand_series(std::span<const std::string> inputs, const SourceOptions& options);

/// `name` with {stem}, {dataset} and {step} replaced; slashes of a dataset's path become dots. Throws
/// Error(usage) for any other word in braces.
std::string step_name(std::string_view name, const SeriesStep& step);

/// Where each step's file goes: beside its input where `output` is empty; into `output` where that ends with a
/// slash, or is a directory and there are several; else to the name it gives, with the braces of its last part
/// replaced. A name says {stem}.nvdb by default, {stem}_{step}.nvdb for several steps of one file. Throws Error(usage)
/// where two steps would share one name.
std::vector<std::string> series_outputs(std::span<const SeriesStep> steps, const std::string& output);

}  // namespace weir
