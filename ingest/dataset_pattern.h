// The datasets that a pattern in --dataset stands for.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "format/base/message.h"
#include "ingest/source/dataset_info.h"
#include "ingest/source/source_options.h"

namespace weir {

/// Whether `pattern`, a name with or without its first slash or one with *, ? and [...], is for the dataset `name`.
bool names_dataset(const std::string& pattern, const std::string& name);

/// The names of those of `datasets`, of the file `path`, that *, ? and [...] in `pattern`, which match slashes, too,
/// match and that are volumes where --index and --component are as in `options`; or the one that is called like the
/// pattern itself. Those that are read by name only are left out of patterns without a word. `notice` gets a line for
/// each other one that matches and that other options make a volume of, with these, and each that would be a volume but
/// for its obstacle. Throws Error(input) where no name matches or all that match have an obstacle, and Error(usage)
/// where other options make a volume of one, with what is said of each.
std::vector<std::string> matching_datasets(const std::string& path, std::span<const DatasetInfo> datasets,
                                           const std::string& pattern, const SourceOptions& options,
                                           const Notice& notice);

}  // namespace weir
