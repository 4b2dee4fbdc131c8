// The series that a file belongs to: the files beside it whose names are the same but for their numbers, as
// step_0042.nvdb and step_0043.nvdb are.
#pragma once

#include <string>
#include <vector>

namespace weir {

/// The same text for all files of one series, and for no other.
std::string series_key(const std::string& path);

/// The same of a path from wherever it is named, as 32 hex digits, from which no path can be read.
std::string series_digest(const std::string& path);

/// The files of its series that are there now, in natural order, in the words of `path` ("nvdb/a_7.nvdb"). One whose
/// name has no number is a series of its own. Throws Error(io) where the directory cannot be read.
std::vector<std::string> files_of_series(const std::string& path);

}  // namespace weir
