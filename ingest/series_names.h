// What the files are called that volumes are converted to.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ingest/series.h"

namespace weir {

/// `name` with {stem}, {dataset} and {step} replaced; slashes of a dataset's path become dots. Throws
/// Error(usage) for any other word in braces.
std::string step_name(std::string_view name, const SeriesStep& step);

/// What a volume is called where nobody says it.
enum class DefaultNames {
  /// {stem}, and of dataset, component, level and position each that was chosen among several of the file: another
  /// volume of it has another name, whichever call converts it. {stem}.nvdb of a file that holds one volume.
  of_file,
  /// {stem}.nvdb; for several volumes of one file {stem}_{step}.nvdb, {stem}_{dataset}.nvdb or
  /// {stem}_{dataset}_{step}.nvdb, the first that tells those of this call apart.
  of_call
};

/// Where each step's file goes: beside its input where `output` is empty; into `output` where that ends with a
/// slash, or is a directory and there are several; else to the name it gives, with the words in braces of its last part
/// replaced. Where `output` gives no name, `names` does. Of Levels::separate each name ends with _level_N.nvdb, N from
/// 0, the finest, on. `options` are those that the steps were made with, and files that hold several volumes are listed
/// for it. Throws Error(usage) where two steps would share one name, a directory has such a word, a step has no
/// {step} and the name has, or a {dataset} that a step has not would leave a name empty before its extension.
std::vector<std::string> series_outputs(std::span<const SeriesStep> steps, const std::string& output,
                                        const SourceOptions& options = {}, DefaultNames names = DefaultNames::of_file);

}  // namespace weir
