// What a conversion that was killed leaves in an output directory, and its
// removal. Results are never touched.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace weir {

struct CleaningReport {
  std::vector<std::string> removed;  ///< paths
  std::vector<std::string> left;     ///< in use by another process, or not removable: "PATH: reason"
};

/// Removes from `directory` (and below it, where `recursive`; a missing one is no error): X.nvdb.partial and
/// X.nvdb.json.partial, hidden thumbnails that were being written (.X.nvdb.png.PID.partial) and work directories
/// (.X.nvdb.work), but not one that a conversion of a source that has not changed can be continued from and that was
/// written to in the last seven days. X.nvdb.json.previous becomes X.nvdb.json again where that is missing. A partial
/// file that a living process writes is locked by it: it is waited for, `patience` altogether (the children of a daemon
/// that was killed die a moment after it), and then left, with its work directory.
CleaningReport clean_outputs(const std::string& directory, bool recursive, std::chrono::milliseconds patience);

}  // namespace weir
