// A directory of one's own for a while.
#pragma once

#include <stdlib.h>

#include <cerrno>
#include <filesystem>
#include <string>

#include "format/base/error.h"
#include "format/io/temporary_directory.h"

namespace weir {

class TemporaryFolder {
 public:
  /// Made in `parent`, or where temporary files are where that is empty. Throws Error(io).
  explicit TemporaryFolder(const std::string& parent = "") {
    std::string name =
        (std::filesystem::path(parent.empty() ? temporary_directory() : parent) / "weir-view-XXXXXX").string();
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
  std::filesystem::path path_;
};

}  // namespace weir
