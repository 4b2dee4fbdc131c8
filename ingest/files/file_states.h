// The files of a volume with their states. If there are several, their total size and newest time do not tell whether
// one of them has changed.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "format/io/digest.h"
#include "ingest/files/file_state.h"

namespace weir {

class FileStates {
 public:
  /// Adds the current state of the file at `path`: its name without the directory, its size and its times of
  /// modification and status change. A file that was replaced by another of the same size and modification time thus
  /// counts as changed. `named` is the digest of the states of the files that it names, if any. Call add() before the
  /// file is opened, so that a change in between is noticed later. Opening refuses a missing file.
  void add(const std::string& path, const std::string& named = {}) { add(look_at_file(path), named); }
  void add(const FileState& file, const std::string& named = {});

  /// Returns 32 hex digits that depend on the order of the files. Returns "" for fewer than two files.
  std::string digest() const;

  /// Returns the files that were added.
  const std::vector<FileState>& files() const { return all_; }

 private:
  std::size_t files_ = 0;  ///< number of files, including those that others name
  DigestStream states_;
  std::vector<FileState> all_;
};

}  // namespace weir
