// A file mapped read-only, with its descriptor. Owns both.
#pragma once

#include <cstddef>
#include <cstdint>
#include <ctime>
#include <span>
#include <string>

#include "format/io/descriptor.h"

namespace weir {

/// Looking at bytes() of a file that another process truncates ends this one by SIGBUS, as with any mapping;
/// populate, read and check_unchanged report it instead. All const calls may be made by any thread at any time.
class FileMapping {
 public:
  /// Throws Error(input) for a missing, empty or no regular file; `suffix`, ".nvdb", is what should have been given.
  /// Error(io) where it cannot be opened or mapped although it may be a good one: no right, no memory, a file server.
  FileMapping(const std::string& path, const std::string& suffix);
  /// The same of `file`, open for reading, whatever has `path` now, which messages name.
  FileMapping(Descriptor file, const std::string& path, const std::string& suffix);
  ~FileMapping();
  FileMapping(FileMapping&& other) noexcept;
  FileMapping& operator=(FileMapping&&) = delete;
  FileMapping(const FileMapping&) = delete;
  FileMapping& operator=(const FileMapping&) = delete;

  const std::string& path() const { return path_; }
  std::span<const std::byte> bytes() const { return bytes_; }
  /// Of the file as it was opened, whatever has the path now.
  int descriptor() const { return file_.get(); }

  /// Releases the pages read so far, since mapped pages count as the process's memory; they stay in the page cache and
  /// are mapped again when they are read.
  void release_pages() const;
  /// True where a sample of the pages of [offset, offset + bytes) is in the page cache, or the system does not tell.
  bool cached(std::uint64_t offset, std::uint64_t bytes) const;
  /// Starts to read what is not in the page cache; returns before it is there.
  void prefetch(std::uint64_t offset, std::uint64_t bytes) const;
  /// Reads and maps the pages of [offset, offset + bytes) at once, where the system can (Linux 5.14), else does
  /// nothing. Throws Error(input) where the file was truncated, Error(io) where the disk cannot be read.
  void populate(std::uint64_t offset, std::uint64_t bytes) const;
  /// The file's bytes from `offset` on, by pread. Throws Error(input) where it ends before, Error(io) where it cannot
  /// be read.
  void read(std::uint64_t offset, std::span<std::byte> into) const;
  /// Throws Error(input) where the file's size or time of change is not that at opening. A change through another
  /// mapping may be noticed late.
  void check_unchanged() const;
  /// Whether `path` leads to the file that is mapped: another one may have been given its name.
  bool is_at(const std::string& path) const;

 private:
  std::string path_;
  Descriptor file_;
  std::timespec changed_{};
  std::span<const std::byte> bytes_;
};

}  // namespace weir
