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
/// X.nvdb.json.partial, pictures that nobody writes any more (X.nvdb.png.partial) and work directories
/// (.X.nvdb.work), but not one that a conversion can be continued from: of a source elsewhere than in `sources` as long
/// as it is there (a user's, who will come back to it), of one in it until that source has gone or changed or the
/// directory was not written to for seven days. X.nvdb.json.previous becomes X.nvdb.json again where that is missing,
/// or where a commit that was killed has put it beside the old volume (commit_leftovers.h); if that had none, it is
/// removed. All that under the output's lock, X.nvdb.partial: one that a living process holds is waited for, `patience`
/// altogether (the children of a daemon that was killed die a moment after it), and then that output is left alone.
CleaningReport clean_outputs(const std::string& directory, const std::string& sources, bool recursive,
                             std::chrono::milliseconds patience);

/// Removes from `directory` what interrupted conversions of the file `source` can be continued from; what a living
/// process holds is left.
CleaningReport discard_interrupted(const std::string& directory, const std::string& source);

}  // namespace weir
