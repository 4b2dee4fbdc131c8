// Whether a file system is mounted at a path.
#pragma once

#include <string>

namespace weir {

/// Returns whether `path`, symbolic links followed, is the root of a mounted file system. Bind mounts count, from
/// Linux 5.8 on. Returns false if `path` cannot be looked at. Waits as long as the file system there does.
bool is_mount_point(const std::string& path);

}  // namespace weir
