// A file mapped read-only, with its descriptor. Owns both.
#pragma once

#include <cstddef>
#include <cstdint>
#include <ctime>
#include <span>
#include <string>

#include "format/io/descriptor.h"

namespace weir {

/// If another process truncates the file, reading bytes() ends this process by SIGBUS, as with any mapping; populate(),
/// read() and check_unchanged() report it instead. Any thread may make any const call at any time.
class FileMapping {
 public:
  /// Throws Error(input) for a file that is missing, empty or not regular; messages name `suffix` (".nvdb") as what to
  /// give. Throws Error(io) if a file that may be good cannot be opened or mapped: no permission, no memory, a file
  /// server.
  FileMapping(const std::string& path, const std::string& suffix);
  /// Maps `file`, which is open for reading. Messages name `path`, even if another file has that name by now.
  FileMapping(Descriptor file, const std::string& path, const std::string& suffix);
  ~FileMapping();
  FileMapping(FileMapping&& other) noexcept;
  FileMapping& operator=(FileMapping&&) = delete;
  FileMapping(const FileMapping&) = delete;
  FileMapping& operator=(const FileMapping&) = delete;

  const std::string& path() const { return path_; }
  std::span<const std::byte> bytes() const { return bytes_; }
  /// Returns the descriptor of the file that was opened, even if another file has the path by now.
  int descriptor() const { return file_.get(); }

  /// Releases the pages read so far, because mapped pages count as the process's memory. They stay in the page cache
  /// and are mapped again when they are read.
  void release_pages() const;
  /// Returns true if a sample of the pages of [offset, offset + bytes) is in the page cache, or if the system does not
  /// tell.
  bool cached(std::uint64_t offset, std::uint64_t bytes) const;
  /// Starts to read the bytes that are not in the page cache; returns before they are there.
  void prefetch(std::uint64_t offset, std::uint64_t bytes) const;
  /// Reads and maps the pages of [offset, offset + bytes) at once if the system can (Linux 5.14); otherwise does
  /// nothing. Throws Error(input) if the file was truncated, Error(io) if the disk cannot be read.
  void populate(std::uint64_t offset, std::uint64_t bytes) const;
  /// Reads the file's bytes from `offset` on, by pread. Throws Error(input) if the file ends before, Error(io) if it
  /// cannot be read.
  void read(std::uint64_t offset, std::span<std::byte> into) const;
  /// Throws Error(input) if the file's size or modification time is not what it was at opening. A change through
  /// another mapping may be noticed late.
  void check_unchanged() const;
  /// Returns whether `path` leads to the mapped file; another file may have been given that name.
  bool is_at(const std::string& path) const;

 private:
  std::string path_;
  Descriptor file_;
  std::timespec changed_{};
  std::span<const std::byte> bytes_;
};

}  // namespace weir
