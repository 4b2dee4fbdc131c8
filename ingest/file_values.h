// Counts the values that a file holds, to tell whether a conversion includes all of them.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "ingest/source/dataset_info.h"
#include "ingest/source/source_options.h"

namespace weir {

/// Returns the number of values of all arrays and grids among the `datasets` of one file. Every component and every
/// position of a leading axis counts, and so do arrays that are no volumes (tables of particles, for instance).
/// Coordinates do not count: a coordinate array has numbers along one axis, or two numbers per element, and a volume
/// has an axis of the same length or one element less. Datasets that are read by name only do not count unless
/// `chosen` (SourceOptions::dataset) names them. An array of unknown extents counts as one value. An array without
/// extents also counts as one value, unless `scalars` says that it is a single number.
std::uint64_t values_of(std::span<const DatasetInfo> datasets, const std::string& chosen, bool scalars);

/// Returns values_of() for the file `path`, opened with `options`. Returns 0 if the number is unknown, because `path`
/// is a directory or cannot be listed.
std::uint64_t file_values(const std::string& path, const SourceOptions& options);

}  // namespace weir
