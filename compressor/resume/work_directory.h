// The directory for spill files: a hidden directory beside the output, made for one conversion, or the directory that
// the user names. Spill files have no names, so that they vanish with the process. Files that must outlive the process
// belong to the journal. The records of leaves stay in memory if the memory ceiling has room for them.
#pragma once

#include <memory>
#include <string>

#include "format/io/file_system.h"
#include "format/io/memory_file_system.h"

namespace weir {

/// Returns the path of ".OUT.nvdb.work" beside OUT.nvdb.
std::string hidden_directory_of(const std::string& output);

/// Removes the directory at `path`, unless it holds files that are not weir's.
void remove_if_empty(FileSystem& files, const std::string& path) noexcept;

/// Throws Error if `chosen`, the --work-dir, cannot be a work directory: of kind io if it is missing, of kind usage if
/// it is a file or lies in memory.
void check_work_directory(FileSystem& files, const std::string& chosen);

class WorkDirectory {
 public:
  /// `chosen` is --work-dir or empty. Throws as check_work_directory, and Error(usage) if the output and /var/tmp both
  /// lie in memory.
  WorkDirectory(FileSystem& files, const std::string& output, const std::string& chosen);
  ~WorkDirectory();
  WorkDirectory(const WorkDirectory&) = delete;
  WorkDirectory& operator=(const WorkDirectory&) = delete;

  const std::string& path() const { return path_; }
  std::unique_ptr<File> spill() { return files_.create_unnamed(path_); }
  /// Returns a file for the records of a conversion's leaves; it lies in memory after hold_records().
  std::unique_ptr<File> spill_records() { return memory_ ? memory_->create_unnamed(path_) : spill(); }
  bool holds_records() const { return memory_ != nullptr; }
  /// Makes later spill_records() files lie in memory. The memory counts towards the conversion's ceiling
  /// (MemoryPlan::record_bytes).
  void hold_records(MemoryFileSystem::PagesOf pages) { memory_ = std::make_unique<MemoryFileSystem>(pages); }

 private:
  FileSystem& files_;
  std::string path_;
  bool made_ = false;
  std::unique_ptr<MemoryFileSystem> memory_;  // null: records are spilled
};

}  // namespace weir
