// The directory that a command writes its results to.
#pragma once

#include <string>
#include <vector>

#include "format/io/file_system.h"

namespace weir {

/// Creates a missing directory and its missing parents. If nothing was put into them, the created directories are
/// removed again.
class ResultDirectory {
 public:
  /// Throws Error(usage) if `path` or a parent exists and is not a directory, Error(io) if it cannot be created.
  /// `files` must outlive the object.
  ResultDirectory(FileSystem& files, const std::string& path);
  ~ResultDirectory();
  ResultDirectory(const ResultDirectory&) = delete;
  ResultDirectory& operator=(const ResultDirectory&) = delete;

  std::string operator/(const std::string& name) const;
  const std::string& path() const { return path_; }

 private:
  void remove_empty() noexcept;

  FileSystem& files_;
  std::string path_;
  std::vector<std::string> made_;  ///< created directories, parents first
};

}  // namespace weir
