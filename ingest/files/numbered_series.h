// The series that a file belongs to: the files beside it with the same name except for the numbers, as step_0042.nvdb
// and step_0043.nvdb.
#pragma once

#include <string>
#include <vector>

namespace weir {

/// Returns a text that is the same for all files of one series, and different for every other series.
std::string series_key(const std::string& path);

/// Returns series_key() as 32 hex digits that do not depend on how the path is written. No path can be read from
/// them.
std::string series_digest(const std::string& path);

/// Returns the existing files of the series of `path`, in natural order, written as `path` is ("nvdb/a_7.nvdb"). A
/// file without a number in its name is a series of its own. Throws Error(io) if the directory cannot be read.
std::vector<std::string> files_of_series(const std::string& path);

}  // namespace weir
