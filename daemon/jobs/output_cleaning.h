// Removes what a killed conversion leaves in an output directory. Results are never touched.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace weir {

struct CleaningReport {
  std::vector<std::string> removed;  ///< paths
  std::vector<std::string> left;     ///< files in use by another process, or not removable: "PATH: reason"
};

/// Removes leftovers from `directory`, and from the directories below it if `recursive`. A missing directory is no
/// error.
///   Removed: X.nvdb.partial, X.nvdb.json.partial, abandoned pictures (X.nvdb.png.partial) and work directories
///   (.X.nvdb.work).
///   Kept: a work directory from which a conversion can be continued. If its source lies outside `sources` (a user's,
///   who will come back to it), it is kept as long as the source exists. If its source lies in `sources`, it is kept
///   until the source is gone or has changed, or the directory was not written to for seven days.
/// X.nvdb.json.previous becomes X.nvdb.json again if that is missing, or if a killed commit has put X.nvdb.json
/// beside the old volume (commit_leftovers.h). If the old volume had no sidecar, X.nvdb.json is removed.
/// All this happens under the output's lock, X.nvdb.partial. If a living process holds the lock, the function waits,
/// up to `patience` in total (the children of a killed daemon die a moment after it), and then leaves that output
/// alone.
CleaningReport clean_outputs(const std::string& directory, const std::string& sources, bool recursive,
                             std::chrono::milliseconds patience);

/// Removes from `directory` the files from which an interrupted conversion of the file `source` can be continued.
/// Files that a living process holds stay.
CleaningReport discard_interrupted(const std::string& directory, const std::string& source);

}  // namespace weir
