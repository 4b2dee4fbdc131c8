// The identity of a source: a single file, or the metadata of a Zarr hierarchy in a directory.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "daemon/store/job.h"

namespace weir {

/// The most groups and arrays of one hierarchy whose metadata are looked at. Directories on the way to a named
/// dataset are looked at in any case.
inline constexpr std::size_t kMostWatchedNodes = 256;
/// The most directory entries that are listed to find groups and arrays, per hierarchy. The limit exists because the
/// event loop makes these looks and serves others, too.
inline constexpr std::size_t kMostListedEntries = 4096;

/// Returns the identity of the file at `path` as identify() does. If the file is the head of a Zarr hierarchy, the
/// identity also covers the metadata of its groups and arrays: `bytes` is their total size, `mtime_ns` the newest
/// time, and `inode` a hash of the states of all these files. So a step that is appended to an array of a group
/// changes the identity.
///   Covered: the groups and arrays on the way to the datasets that --dataset or --magnitude among `convert_options`
///   name, and those in them. If the options name none, those of the whole hierarchy. At most kMostWatchedNodes.
///   Order: groups are looked into, arrays are not; outer groups come first, in the order of their names.
///   Limit: a group whose entries exceed the rest of kMostListedEntries gives no member, and neither do the groups
///   behind it. So the result does not depend on the order that a directory is listed in.
/// Returns none if one of the files cannot be looked at.
std::optional<FileIdentity> identify_source(const std::string& path, const std::vector<std::string>& convert_options);

}  // namespace weir
