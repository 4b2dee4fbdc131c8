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

/// Thread-safe. "." exists, and what is made; files may lie in any directory.
class CrashFileSystem final : public FileSystem {
 public:
  using Bytes = std::vector<std::byte>;

  /// Content of a file, until it is written again; empty where there is none.
  const Bytes& content(const std::string& path) const;
  /// Content of a file, which is removed; empty where there was none.
  Bytes take(const std::string& path);
  std::vector<std::string> names() const;
  /// Those that were made and not removed.
  std::vector<std::string> directories() const;

  /// As if the machine had lost power: every file holds what it held when it was last flushed, and has the names that
  /// it had when their directories were. A rename happens at both places or at none.
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
