// The identity of a source: of a file, or of the metadata of a Zarr hierarchy in a directory.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "daemon/store/job.h"

namespace weir {

/// Groups and arrays of one hierarchy whose metadata are looked at, those on the way to what is named aside.
inline constexpr std::size_t kMostWatchedNodes = 256;
/// Entries of directories that are listed to find them, over one hierarchy: an event loop looks at them, which has
/// others to serve.
inline constexpr std::size_t kMostListedEntries = 4096;

/// That of the file at `path`, as identify() says. Where the file is the head of a Zarr hierarchy: also of the metadata
/// of the groups and arrays on the way to what --dataset or --magnitude among `convert_options` name, and in it, or of
/// all, kMostWatchedNodes in any case, where they name none: the total size, the newest time, and an inode that is
/// another one wherever a state of those files is. So a step that is appended to an array of a group makes another
/// identity. Arrays are not looked into, groups are, the outer ones first and in the order of their names; of the group
/// with which they have more than kMostListedEntries entries, and of those behind it, none is taken, so that the order
/// in which a directory is listed does not matter. None where one of the files cannot be looked at.
std::optional<FileIdentity> identify_source(const std::string& path, const std::vector<std::string>& convert_options);

}  // namespace weir
