// All datasets of a file, by whatever links they are reached.
#pragma once

#include <functional>
#include <string>

#include "ingest/hdf5/file/hdf5_handle.h"

namespace weir {

/// Links of other files that are followed while one file is walked: each keeps its file open.
inline constexpr std::size_t kMaxExternalLinks = 256;

/// Groups within groups that are walked: opening one takes the library a time that grows with its depth.
inline constexpr int kMaxGroupDepth = 256;

/// Calls `visit` with the name ("/a/b c") and the open handle of each dataset and each openPMD constant at or
/// below the group `name` of `file`, sorted by name within a group, its datasets before its groups'. What
/// several links lead to is visited once, by a link of its own file where there is one; links that lead in
/// circles end there, links of other files that lead nowhere are passed over. Soft links are not followed: what they
/// lead to has a name of its own. Calls `damaged` with the name of what cannot be opened, or of the group that cannot
/// be listed whole, and why: "cannot be opened: REASON; the file is damaged". Throws Error(input) for groups nested
/// deeper than kMaxGroupDepth. The caller holds Hdf5Lock.
void walk_datasets(hid_t file, const std::string& name,
                   const std::function<void(std::string name, Hdf5Handle object)>& visit,
                   const std::function<void(std::string name, const std::string& why)>& damaged);

}  // namespace weir
