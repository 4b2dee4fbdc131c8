// A file system in memory that can lose what was not flushed, so that a test can run hundreds of conversions
// without a disk.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "format/io/file_system.h"

namespace weir::test {

/// Thread-safe. "." exists, and every directory that was made. Files may lie in any directory.
class CrashFileSystem final : public FileSystem {
 public:
  using Bytes = std::vector<std::byte>;

  /// Returns the content of a file, valid until it is written again; empty if the file does not exist.
  const Bytes& content(const std::string& path) const;
  /// Removes a file and returns its content; empty if the file did not exist.
  Bytes take(const std::string& path);
  std::vector<std::string> names() const;
  /// Returns the directories that were made and not removed.
  std::vector<std::string> directories() const;

  /// Acts as if the machine lost power. Every file gets the content of its last flush, and the names that it had when
  /// their directories were last flushed. A rename happens in both directories or in neither.
  void lose_unflushed();

  std::unique_ptr<File> create(const std::string& path) override;
  std::unique_ptr<File> open(const std::string& path) override;
  std::unique_ptr<File> create_unnamed(const std::string& directory) override;
  void rename(const std::string& from, const std::string& to) override;
  void rename_new(const std::string& from, const std::string& to) override;
  bool link(const std::string& from, const std::string& to) override;
  void remove(const std::string& path) override;
  void make_directory(const std::string& path) override;
  void remove_directory(const std::string& path) override;
  void sync_directory(const std::string& path) override;
  bool exists(const std::string& path) override;
  bool is_memory(const std::string& directory) override;
  std::uint64_t free_bytes(const std::string& directory) override;

 private:
  friend class CrashFile;
  struct Stored;
  using Files = std::map<std::string, std::shared_ptr<Stored>>;

  mutable std::mutex mutex_;
  Files files_;
  Files durable_files_;
  std::set<std::string> directories_;
  std::set<std::string> durable_directories_;
};

}  // namespace weir::test
