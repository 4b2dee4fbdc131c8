// Finds the dataset that a user names, or fails with an error that lists what the file has.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ingest/hdf5/file/hdf5_object.h"

namespace weir {

/// Opens the dataset (or openPMD constant) `name` of `file`, with the path `path`, and adds a missing first slash.
/// Follows soft and external links. Throws Error(input), naming similar and other datasets, if `name` is missing, a
/// group, or a link that leads nowhere. The caller holds Hdf5Lock.
Hdf5Object find_dataset(hid_t file, const std::string& path, const std::string& name);

/// Returns at most `count` of `names` (paths with slashes) with a last part like the last part of `wanted`, nearest
/// first. Parts are alike if they are equal, differ only by case, or differ by up to two insertions, deletions and
/// replacements of characters (Levenshtein's distance; at most a third of the length).
std::vector<std::string> near_names(std::string_view wanted, std::span<const std::string> names, std::size_t count);

}  // namespace weir
