// An input file, read without disturbing the page cache: bytes that are cached
// are taken from there, others go past it (O_DIRECT) or, where that is refused,
// through it and out again. A simulation on the same machine keeps its pages.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "format/io/descriptor.h"
#include "ingest/files/file_state.h"

namespace weir {

enum class DirectIo {
  automatic,  ///< past the page cache for bytes that are not in it, where the file system can
  on,         ///< always past the page cache; an error where the file system cannot
  off         ///< always through the page cache
};

/// Where a read gets its bytes from.
enum class ReadPath {
  cache,   ///< all of them are in the page cache
  direct,  ///< past the page cache: read_direct
  through  ///< through the page cache and out of it again
};

/// Alignment of offset, size and memory of direct reads: enough for every common device.
inline constexpr std::uint64_t kDirectAlignment = 4096;

/// A regular file opened for reading. Reads may run in several threads at once.
class InputFile {
 public:
  /// Throws Error(input) where the file is missing, no regular file, unreadable or empty, and, with
  /// DirectIo::on, where the file system has no direct I/O.
  InputFile(const std::string& path, DirectIo mode) : InputFile(path, mode, path) {}
  /// The same, but path() and messages say `shown`: of files without a name, opened by /proc/self/fd.
  InputFile(const std::string& path, DirectIo mode, const std::string& shown);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::string& path() const { return path_; }
  std::uint64_t size() const { return size_; }
  std::int64_t mtime_ns() const { return state_.mtime_ns; }
  /// As it was when it was opened.
  const FileState& state() const { return state_; }
  /// Bytes the file system was asked for so far, alignment included.
  std::uint64_t bytes_read() const { return bytes_read_.load(std::memory_order_relaxed); }

  /// How bytes [offset, offset + count) should be read. Looks only, reads nothing.
  ReadPath path_for(std::uint64_t offset, std::uint64_t count) const;

  /// Whether the whole file lies in the page cache, as far as 256 pages spread over it tell, and may be
  /// read from there.
  bool looks_cached() const;

  /// Fills `into` from `offset` through the page cache. On the path `through`, pages this read brought
  /// in are dropped again and pages that were there stay; on `cache` none is looked at. Throws
  /// Error(input) where the file ends early (it was cut since it was opened), Error(io) where the
  /// device fails.
  void read_buffered(std::uint64_t offset, std::span<std::byte> into, ReadPath path);

  /// Reads [offset, offset + count) past the page cache into `staging`, which is aligned to
  /// kDirectAlignment and holds at least count + 2 * kDirectAlignment bytes, and returns where
  /// they lie in it. A file system that refuses at this point is read through the page cache from then
  /// on, unless the mode is DirectIo::on. Throws as read_buffered.
  std::span<const std::byte> read_direct(std::uint64_t offset, std::uint64_t count, std::span<std::byte> staging);

 private:
  /// Pages per mincore call, and so the bytes read_buffered reads before it drops what it brought in.
  static constexpr std::size_t kPagesPerLook = 1024;

  /// mincore's answer for the pages from `first` on; what cannot be known counts as resident.
  void look(std::uint64_t first, std::span<unsigned char> resident) const;
  bool is_cached(std::uint64_t offset, std::uint64_t count) const;
  void read_through(std::uint64_t offset, std::span<std::byte> into);
  void fill(std::uint64_t offset, std::span<std::byte> into);
  /// Reads until `into` is full or the file ends and returns the bytes read. `refused` is given for
  /// direct reads only and set where the file system answers EINVAL.
  std::size_t read_some(int descriptor, std::uint64_t offset, std::span<std::byte> into, bool* refused = nullptr);
  [[noreturn]] void throw_refused() const;
  [[noreturn]] void throw_short(std::uint64_t offset, std::uint64_t count, std::uint64_t end) const;

  std::string path_;
  DirectIo mode_;
  Descriptor buffered_;
  Descriptor direct_;  ///< -1 where direct I/O is off or refused
  std::uint64_t size_ = 0;
  FileState state_;
  std::byte* mapping_ = nullptr;  ///< of the whole file, for mincore only: never dereferenced
  std::atomic<bool> direct_works_{false};
  std::atomic<std::uint64_t> bytes_read_{0};
};

}  // namespace weir
