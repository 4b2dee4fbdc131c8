// How many values a file holds, to know whether a conversion has all of them.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "ingest/source/dataset_info.h"
#include "ingest/source/source_options.h"

namespace weir {

/// Values of all arrays and grids among `datasets`, of one file: of every component and every position of a leading
/// axis, and of arrays that are no volumes, tables of particles for instance. Not counted are coordinates: numbers
/// along one axis, or two numbers for each element of it, where a volume has an axis of so many elements or one fewer.
/// Nor are those that are read by name only, but for what `chosen`, SourceOptions::dataset, names. An array whose
/// extents are not known counts as one value; one that has none, too, where not `scalars` says that it is a single
/// number.
std::uint64_t values_of(std::span<const DatasetInfo> datasets, const std::string& chosen, bool scalars);

/// The same of the file `path`, which `options` open; 0 where that is not known: of a directory, or what cannot be
/// listed.
std::uint64_t file_values(const std::string& path, const SourceOptions& options);

}  // namespace weir
