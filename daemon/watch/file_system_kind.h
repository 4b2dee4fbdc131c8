// Tells whether inotify sees all changes on a file system.
#pragma once

#include <cstdint>
#include <string>

struct statfs;

namespace weir {

struct FileSystemKind {
  std::string name;               ///< "ext4", "nfs", ..., or "type 0x1234" if weir does not know it
  bool sees_all_changes = false;  ///< all changes pass through this machine's kernel, so that inotify reports them
};

/// Returns the kind for the type number of statfs. An unknown type counts as not local, because polling is slower but
/// never misses a change.
FileSystemKind file_system_kind(std::uint64_t statfs_type);
FileSystemKind file_system_kind(const struct statfs& status);
/// Returns the kind of the file system of `path`. Throws Error(io) if the system cannot tell.
FileSystemKind file_system_kind(const std::string& path);

}  // namespace weir
