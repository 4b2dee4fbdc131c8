// One output file that is complete or absent: its bytes are in FILE.partial until `commit`.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <memory>
#include <string>

#include "format/io/file_system.h"

namespace weir {

class PartialFile {
 public:
  /// Creates and locks PATH.partial. Throws Error(usage) where `path` exists and `overwrite` is false, is no regular
  /// file or has too long a name, Error(io) where its directory is missing or not writable or another process writes
  /// it. `files` must outlive the object.
  PartialFile(FileSystem& files, const std::string& path, bool overwrite);
  /// Removes what was not committed, if that has its name still; in a process that was forked since, nothing.
  ~PartialFile();
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

  /// Sets the size and reserves the blocks, so that a full disk is known before the first byte.
  /// Throws Error(io) where they are not there; on a file system that cannot reserve, where the free
  /// space is less at this moment.
  void reserve(std::uint64_t bytes);
  File& file() { return *file_; }
  /// Flushes the file, renames it into place (1, 2) and flushes the directory (3). A crash before 2 is
  /// done leaves what was there before. Throws Error(io), besides, where PATH.partial was removed or replaced.
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
