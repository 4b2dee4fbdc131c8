// A file system over the real one in which one chosen call fails, so that a test can try every call of a protocol in
// turn.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "format/io/file_system.h"

namespace weir {

/// Counts the calls that change something or ask for room, including calls on files. Thread-safe.
class FaultyFileSystem final : public FileSystem {
 public:
  enum class After {
    works,  ///< calls after the failed call work
    fails   ///< calls after the failed call change nothing, as if the process had been killed
  };
  /// Call number `fail_at` (0 is the first) fails with `errno_value`. If `fail_at` is negative, no call fails.
  FaultyFileSystem(FileSystem& real, int fail_at, int errno_value, After after = After::works);

  /// Counts from the rename of a file to `path` instead of from the beginning: call number `fail_at` after it fails.
  void fail_after_rename_to(const std::string& path, int fail_at);

  /// From now on link() does nothing, as on exFAT.
  void take_links_away() { has_links_ = false; }

  /// From now on free_bytes() returns `bytes`.
  void leave_free(std::uint64_t bytes) { free_bytes_ = bytes; }

  /// Returns the names of the counted calls so far, in order: "create", "write", "preallocate", "sync", "rename", ...
  std::vector<std::string> calls() const;
  bool failed() const { return failed_; }

  std::unique_ptr<File> create(const std::string& path) override;
  std::unique_ptr<File> open(const std::string& path) override;
  std::unique_ptr<File> open_to_read(const std::string& path) override;
  std::unique_ptr<File> create_unnamed(const std::string& directory) override;
  void rename(const std::string& from, const std::string& to) override;
  void rename_new(const std::string& from, const std::string& to) override;
  bool link(const std::string& from, const std::string& to) override;
  void remove(const std::string& path) override;
  void make_directory(const std::string& path) override;
  void remove_directory(const std::string& path) override;
  void sync_directory(const std::string& path) override;
  bool exists(const std::string& path) override;
  bool is_replaceable(const std::string& path) override;
  bool is_memory(const std::string& directory) override;
  std::uint64_t free_bytes(const std::string& directory) override;

  /// Counts a call, and throws if this call is chosen to fail.
  void count(const std::string& call, const std::string& path);

 private:
  void renamed(const std::string& to);

  FileSystem& real_;
  int fail_at_;
  int errno_value_;
  After after_;
  std::string awaited_name_;
  int fail_after_it_ = -1;
  bool has_links_ = true;
  std::optional<std::uint64_t> free_bytes_;
  mutable std::mutex mutex_;
  std::vector<std::string> calls_;
  std::atomic<bool> failed_{false};
};

}  // namespace weir
