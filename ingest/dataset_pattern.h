// Finds the datasets of a file that a pattern in --dataset matches.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "format/base/message.h"
#include "ingest/source/dataset_info.h"
#include "ingest/source/source_options.h"

namespace weir {

/// Returns whether `pattern` matches the dataset `name`. `pattern` is a name, with or without its first slash, or a
/// pattern with *, ? and [...].
bool names_dataset(const std::string& pattern, const std::string& name);

/// Returns the names of the `datasets` of the file `path` that match `pattern` and are volumes with the --index and
/// --component of `options`. In `pattern`, *, ? and [...] also match slashes. If a dataset's name equals the pattern
/// itself, returns that name alone. Datasets that are read by name only are left out of patterns without a notice.
/// `notice` gets a line for each other match that needs other options to be a volume, with these options, and for
/// each match that only its obstacle keeps from being a volume. Throws Error(input) if no name matches or every match
/// has an obstacle. Throws Error(usage) if other options make a volume of a match, and lists each match with its
/// reason.
std::vector<std::string> matching_datasets(const std::string& path, std::span<const DatasetInfo> datasets,
                                           const std::string& pattern, const SourceOptions& options,
                                           const Notice& notice);

}  // namespace weir
