// The files that a volume lies in, with their states: where there are several, their total size and newest time do not
// tell whether one of them has changed.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "format/io/digest.h"
#include "ingest/files/file_state.h"

namespace weir {

class FileStates {
 public:
  /// The file at `path` as it is now: name without its directory, size, times of modification and of status change. So
  /// a file that was replaced by one of the same size and time is another. `named` is the digest of the states of those
  /// that it names, if any. Call it before the file is opened, so that a change in between is seen later; opening
  /// refuses a missing file.
  void add(const std::string& path, const std::string& named = {}) { add(look_at_file(path), named); }
  void add(const FileState& file, const std::string& named = {});

  /// 32 hex digits, which depend on the order; empty where there are fewer than two files.
  std::string digest() const;

  /// Those added.
  const std::vector<FileState>& files() const { return all_; }

 private:
  std::size_t files_ = 0;  ///< those that others name among them
  DigestStream states_;
  std::vector<FileState> all_;
};

}  // namespace weir
