// Files in the memory of this process, for a conversion with a result that stays in memory.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>

#include "format/io/file_system.h"

namespace weir {

/// A file's bytes are contiguous and page-aligned. A file grows by moving pages, not bytes, and pages that are not
/// written cost no memory. preallocate() reserves no memory, so memory may still run out later; the system then ends
/// the process. The only directory is "."; is_memory() denies that it is memory, because callers of this class want
/// their files in memory. Thread-safe.
class MemoryFileSystem final : public FileSystem {
 public:
  /// The source of a file's pages. the_system: new pages, which read as zero where nothing was written. earlier_files:
  /// pages of earlier files of this kind (ReusedPages), which need not be made and hold arbitrary bytes until they are
  /// written.
  enum class PagesOf { the_system, earlier_files };

  explicit MemoryFileSystem(PagesOf pages = PagesOf::the_system);
  ~MemoryFileSystem() override;

  /// Returns the bytes of a file, valid until the file is written to, removed or replaced, or the file system ends.
  /// Throws Error(io) if there is no such file.
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
  /// Returns the bytes that the process can still take (available_bytes()).
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
