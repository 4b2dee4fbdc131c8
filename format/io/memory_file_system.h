// Files in the memory of this process, for a conversion whose result is to stay in memory and not go to a disk.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>

#include "format/io/file_system.h"

namespace weir {

/// The bytes of a file are contiguous and page-aligned. It grows by moving pages, not bytes, and what was not written
/// costs no memory; nor is it reserved by preallocate, so that memory may still run out later, which the system tells
/// by ending the process. The only directory is ".", and it is not said to be memory: this is for callers that want
/// just that. Thread-safe.
class MemoryFileSystem final : public FileSystem {
 public:
  /// What files are made of: pages that read zero where nothing was written, or those of earlier files of this kind,
  /// which read anything there and need not be made (ReusedPages).
  enum class PagesOf { the_system, earlier_files };

  explicit MemoryFileSystem(PagesOf pages = PagesOf::the_system);
  ~MemoryFileSystem() override;

  /// The bytes of a file, until it is written to, removed or replaced, or the file system ends. Throws Error(io) where
  /// there is none.
  std::span<const std::byte> content(const std::string& path) const;

  std::unique_ptr<File> create(const std::string& path) override;
  std::unique_ptr<File> open(const std::string& path) override;
  std::unique_ptr<File> open_to_read(const std::string& path) override;
  std::unique_ptr<File> create_unnamed(const std::string& directory) override;
  void rename(const std::string& from, const std::string& to) override;
  void rename_new(const std::string& from, const std::string& to) override;
  bool link(const std::string& from, const std::string& to) override;
  void remove(const std::string& path) override;
  void make_directory(const std::string&) override {}
  void remove_directory(const std::string&) override {}
  void sync_directory(const std::string&) override {}
  bool exists(const std::string& path) override;
  bool is_memory(const std::string&) override { return false; }
  /// What the process can still take (available_bytes).
  std::uint64_t free_bytes(const std::string& directory) override;

 private:
  class Pages;
  class PagesFile;

  std::shared_ptr<Pages> find(const std::string& path) const;

  const PagesOf pages_;
  mutable std::mutex mutex_;
  std::map<std::string, std::shared_ptr<Pages>> files_;
};

}  // namespace weir
