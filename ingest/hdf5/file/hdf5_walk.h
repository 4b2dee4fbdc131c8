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

/// What is not visited, and why: "cannot be opened: REASON; the file is damaged".
struct UnreadObject {
  std::string name;
  std::string why;
  bool elsewhere = false;  ///< a link that leads nowhere: nothing of the file itself is missing
};

/// Calls `visit` with the name ("/a/b c") and the open handle of each dataset and each openPMD constant at or
/// below the group `name` of `file`, sorted by name within a group, its datasets before its groups'. What
/// several links lead to is visited once, by a link of its own file where there is one; links that lead in
/// circles end there. Soft links are not followed: what they lead to has a name of its own. Calls `unread` for what
/// cannot be opened, soft links that lead nowhere included, a group that cannot be listed whole, and the first link to
/// another file that is one too many. Throws Error(input) for groups nested deeper than kMaxGroupDepth. The caller
/// holds Hdf5Lock.
void walk_datasets(hid_t file, const std::string& name,
                   const std::function<void(std::string name, Hdf5Handle object)>& visit,
                   const std::function<void(const UnreadObject&)>& unread);

}  // namespace weir
