// A temporary directory that only its owner uses.
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
  /// Creates the directory in `parent`, or in the directory for temporary files if `parent` is empty. Throws
  /// Error(io).
  explicit TemporaryFolder(const std::string& parent = "") {
    std::string name =
        (std::filesystem::path(parent.empty() ? temporary_directory() : parent) / "weir-view-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw io_error(name, "make a directory", errno);
    path_ = name;
  }
  /// Removes the directory with its content.
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
