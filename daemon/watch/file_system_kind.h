// Whether inotify sees what happens on a file system.
#pragma once

#include <cstdint>
#include <string>

struct statfs;

namespace weir {

struct FileSystemKind {
  std::string name;               ///< "ext4", "nfs", ..., or "type 0x1234" where weir does not know it
  bool sees_all_changes = false;  ///< all changes pass through this machine's kernel, so that inotify reports them
};

/// By the number statfs gives as its type. What is not known to be local is not: polling is slower and never wrong.
FileSystemKind file_system_kind(std::uint64_t statfs_type);
FileSystemKind file_system_kind(const struct statfs& status);
/// Of the file system that `path` lies on. Throws Error(io) where it cannot be asked.
FileSystemKind file_system_kind(const std::string& path);

}  // namespace weir
