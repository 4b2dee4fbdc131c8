// Where spill files go: a hidden directory beside the output, made for one
// conversion, or the directory the user names. Spill files have no names, so that nothing of them outlives the process;
// files that are to outlive it belong to the journal. Where the memory ceiling has room for them, the records of leaves
// are not spilled.
#pragma once

#include <memory>
#include <string>

#include "format/io/file_system.h"
#include "format/io/memory_file_system.h"

namespace weir {

/// ".OUT.nvdb.work" beside OUT.nvdb.
std::string hidden_directory_of(const std::string& output);

/// Removes the directory at `path`, unless it holds files that are not weir's.
void remove_if_empty(FileSystem& files, const std::string& path) noexcept;

/// Throws Error where `chosen`, the --work-dir, cannot be one: of kind io where it is missing, usage where it is a file
/// or in memory.
void check_work_directory(FileSystem& files, const std::string& chosen);

class WorkDirectory {
 public:
  /// `chosen` is --work-dir or empty. Throws as check_work_directory, and Error(usage) where the output lies in memory
  /// and so does /var/tmp.
  WorkDirectory(FileSystem& files, const std::string& output, const std::string& chosen);
  ~WorkDirectory();
  WorkDirectory(const WorkDirectory&) = delete;
  WorkDirectory& operator=(const WorkDirectory&) = delete;

  const std::string& path() const { return path_; }
  std::unique_ptr<File> spill() { return files_.create_unnamed(path_); }
  /// For the records of a conversion's leaves.
  std::unique_ptr<File> spill_records() { return memory_ ? memory_->create_unnamed(path_) : spill(); }
  bool holds_records() const { return memory_ != nullptr; }
  /// The next of those files are memory, which the conversion's ceiling has to hold (MemoryPlan::record_bytes).
  void hold_records(MemoryFileSystem::PagesOf pages) { memory_ = std::make_unique<MemoryFileSystem>(pages); }

 private:
  FileSystem& files_;
  std::string path_;
  bool made_ = false;
  std::unique_ptr<MemoryFileSystem> memory_;  // null: records are spilled
};

}  // namespace weir
