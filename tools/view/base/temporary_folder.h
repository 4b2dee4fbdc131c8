// A directory of one's own for a while.
#pragma once

#include <stdlib.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {

class TemporaryFolder {
 public:
  /// Made in `parent`, or where temporary files are where that is empty. Throws Error(io).
  explicit TemporaryFolder(const std::string& parent = "") {
    std::string name =
        ((parent.empty() ? standard_parent() : std::filesystem::path(parent)) / "weir-view-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw io_error(name, "make a directory", errno);
    path_ = name;
  }
  /// Removed with all that is in it.
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  static std::filesystem::path standard_parent() {
    std::error_code failure;
    std::filesystem::path found = std::filesystem::temp_directory_path(failure);
    if (!failure) return found;
    const char* named = std::getenv("TMPDIR");
    throw Error(ErrorKind::io, cat(named != nullptr ? named : "/tmp",
                                   ": is no directory for temporary files; make it, or set TMPDIR to another one"));
  }

  std::filesystem::path path_;
};

}  // namespace weir
