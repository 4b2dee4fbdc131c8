// One output file that is complete or absent: its bytes are in PATH.partial until commit().
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <string>

#include "format/io/file_system.h"

namespace weir {

class PartialFile {
 public:
  /// Creates and locks PATH.partial. Throws Error(usage) if `path` exists and `overwrite` is false, is not a regular
  /// file, or has too long a name. Throws Error(io) if its directory is missing or not writable, or if another process
  /// writes the output. `files` must outlive the object.
  PartialFile(FileSystem& files, const std::string& path, bool overwrite);
  /// Removes PATH.partial if it was not committed and still has its name; does nothing in a process that was forked
  /// since.
  ~PartialFile();
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

  /// Sets the size and reserves the blocks, so that a full disk is known before the first byte. Throws Error(io) if
  /// there is not enough space; on a file system that cannot reserve, if less is free at this moment.
  void reserve(std::uint64_t bytes);
  File& file() { return *file_; }
  /// Flushes the file, renames it into place (1, 2) and flushes the directory (3). A crash before the end of 2 leaves
  /// what was there before. Also throws Error(io) if PATH.partial was removed or replaced.
  void commit();

 private:
  FileSystem& files_;
  pid_t owner_;
  std::string path_;
  bool overwrite_;
  bool committed_ = false;
  std::unique_ptr<File> file_;
};

}  // namespace weir
