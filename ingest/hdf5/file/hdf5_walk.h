// Finds all datasets of a file, whatever links lead to them.
#pragma once

#include <functional>
#include <string>

#include "ingest/hdf5/file/hdf5_handle.h"

namespace weir {

/// The most links to other files that one walk follows. Each followed link keeps its file open.
inline constexpr std::size_t kMaxExternalLinks = 256;

/// The deepest nesting of groups that is walked. The library's time to open a group grows with its depth.
inline constexpr int kMaxGroupDepth = 256;

/// An object that the walk does not visit, and why: "cannot be opened: REASON; the file is damaged".
struct UnreadObject {
  std::string name;
  std::string why;
  bool elsewhere = false;  ///< a link that leads nowhere: nothing of the file itself is missing
};

/// Calls `visit` with the name ("/a/b c") and the open handle of each dataset and each openPMD constant at or below
/// the group `name` of `file`. Names are sorted within a group; a group's datasets come before its subgroups'
/// datasets. An object with several links is visited once, by a link of its own file if there is one, so circular
/// links end there. Soft links are not followed, because their targets have names of their own. Calls `unread` for
/// objects that cannot be opened, for soft links that lead nowhere, for groups that cannot be listed whole, and for
/// the first link to another file beyond kMaxExternalLinks. Throws Error(input) for groups nested deeper than
/// kMaxGroupDepth. The caller holds Hdf5Lock.
void walk_datasets(hid_t file, const std::string& name,
                   const std::function<void(std::string name, Hdf5Handle object)>& visit,
                   const std::function<void(const UnreadObject&)>& unread);

}  // namespace weir
