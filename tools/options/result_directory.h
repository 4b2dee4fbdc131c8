// The directory that a command's results go to.
#pragma once

#include <string>
#include <vector>

#include "format/io/file_system.h"

namespace weir {

/// Made where it is missing, with those above it; what was made is removed again where nothing came to lie in it.
class ResultDirectory {
 public:
  /// Throws Error(usage) where `path`, or what is above it, is something else than a directory, Error(io) where it
  /// cannot be made. `files` must outlive the object.
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
  std::vector<std::string> made_;  ///< the upper ones first
};

}  // namespace weir
