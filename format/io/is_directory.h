// Whether a path leads to a directory.
#pragma once

#include <sys/stat.h>

#include <string>

namespace weir {

/// Returns false if `path` cannot be looked at.
inline bool is_directory(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 && S_ISDIR(status.st_mode);
}

}  // namespace weir
