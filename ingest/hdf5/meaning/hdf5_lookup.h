// The dataset a user names, or an error that says what there is.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ingest/hdf5/file/hdf5_object.h"

namespace weir {

/// Opens the dataset (or openPMD constant) `name` of `file`, whose path is `path`; a missing first slash is
/// added. Follows soft and external links. Throws Error(input), naming like and other datasets, where it is
/// missing, a group or a link that leads nowhere. The caller holds Hdf5Lock.
Hdf5Object find_dataset(hid_t file, const std::string& path, const std::string& name);

/// Those of `names` (paths with slashes) whose last part is that of `wanted` or differs from it by case or by
/// up to two insertions, deletions and replacements of characters (Levenshtein's distance; a third of
/// its length at most), nearest first, `count` at most.
std::vector<std::string> near_names(std::string_view wanted, std::span<const std::string> names, std::size_t count);

}  // namespace weir
