// Makes the names of the output files that volumes are converted to.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ingest/series.h"

namespace weir {

/// Returns `name` with {stem}, {dataset} and {step} replaced. Slashes of a dataset's path become dots. Throws
/// Error(usage) for any other word in braces.
std::string step_name(std::string_view name, const SeriesStep& step);

/// How an output file is named if the user gives no name.
enum class DefaultNames {
  /// {stem}, followed by the dataset, component, level and position that were chosen among several in the file. Each
  /// volume of a file thus has its own name, whichever call converts it. A file with one volume gives {stem}.nvdb.
  of_file,
  /// {stem}.nvdb. For several volumes of one file: {stem}_{step}.nvdb, {stem}_{dataset}.nvdb or
  /// {stem}_{dataset}_{step}.nvdb, the first of these that gives the volumes of this call different names.
  of_call
};

/// Returns the path of each step's output file. An empty `output` puts it beside its input. If `output` ends with a
/// slash, or is a directory and there are several steps, the file goes into this directory. Otherwise `output` is the
/// path, and the words in braces in its last part are replaced. If `output` gives no name, `names` decides it. With
/// Levels::separate each name ends with _level_N.nvdb; N is 0 for the finest level. `options` are those that the
/// steps were made with; files that hold several volumes are listed with them. Throws Error(usage) if two steps would
/// share a name, if a directory's name has a word in braces, if the name has {step} and a step has none, or if a
/// missing {dataset} would leave a name empty before its extension.
std::vector<std::string> series_outputs(std::span<const SeriesStep> steps, const std::string& output,
                                        const SourceOptions& options = {}, DefaultNames names = DefaultNames::of_file);

}  // namespace weir
