// An input file that is read without disturbing the page cache, so that a simulation on the same machine keeps its
// pages. Cached bytes are taken from the cache. Other bytes are read past the cache (O_DIRECT). If this is refused,
// they are read through the cache and dropped from it again.
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
  automatic,  ///< past the page cache for bytes that are not in it, if the file system supports it
  on,         ///< always past the page cache; an error if the file system does not support it
  off         ///< always through the page cache
};

/// Where a read gets its bytes from.
enum class ReadPath {
  cache,   ///< all bytes are in the page cache
  direct,  ///< past the page cache, by read_direct
  through  ///< through the page cache, and dropped from it again
};

/// Alignment of offset, size and memory of direct reads: enough for every common device.
inline constexpr std::uint64_t kDirectAlignment = 4096;

/// A regular file opened for reading. Reads may run in several threads at once.
class InputFile {
 public:
  /// Throws Error(input) if the file is missing, no regular file, unreadable or empty. With DirectIo::on it also
  /// throws if the file system has no direct I/O.
  InputFile(const std::string& path, DirectIo mode) : InputFile(path, mode, path) {}
  /// Opens `path`, but path() and messages say `shown`. For files without a name, opened by /proc/self/fd.
  InputFile(const std::string& path, DirectIo mode, const std::string& shown);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::string& path() const { return path_; }
  std::uint64_t size() const { return size_; }
  std::int64_t mtime_ns() const { return state_.mtime_ns; }
  /// Returns the state of the file when it was opened.
  const FileState& state() const { return state_; }
  /// Returns the bytes requested from the file system so far, alignment included.
  std::uint64_t bytes_read() const { return bytes_read_.load(std::memory_order_relaxed); }

  /// Returns how bytes [offset, offset + count) should be read. Reads nothing.
  ReadPath path_for(std::uint64_t offset, std::uint64_t count) const;

  /// Returns whether the whole file seems to be in the page cache, by 256 pages spread over it, and may be read from
  /// there.
  bool looks_cached() const;

  /// Fills `into` from `offset` through the page cache. On the path `through`, pages that this read brought in are
  /// dropped again, and pages that were there stay. On the path `cache` no page is checked. Throws Error(input) if
  /// the file ends early (it was cut since it was opened), Error(io) if the device fails.
  void read_buffered(std::uint64_t offset, std::span<std::byte> into, ReadPath path);

  /// Reads [offset, offset + count) past the page cache into `staging`, and returns where the bytes lie in it.
  /// `staging` is aligned to kDirectAlignment and holds at least count + 2 * kDirectAlignment bytes. If the file
  /// system refuses only now, the file is read through the page cache from then on, unless the mode is DirectIo::on.
  /// Throws what read_buffered throws.
  std::span<const std::byte> read_direct(std::uint64_t offset, std::uint64_t count, std::span<std::byte> staging);

 private:
  /// Pages per mincore call, and so also per read of read_buffered before it drops the pages that it brought in.
  static constexpr std::size_t kPagesPerLook = 1024;

  /// Gets mincore's answer for the pages from `first` on. Unknown pages count as resident.
  void look(std::uint64_t first, std::span<unsigned char> resident) const;
  bool is_cached(std::uint64_t offset, std::uint64_t count) const;
  void read_through(std::uint64_t offset, std::span<std::byte> into);
  void fill(std::uint64_t offset, std::span<std::byte> into);
  /// Reads until `into` is full or the file ends, and returns the bytes read. `refused` is given for direct reads
  /// only, and set to true if the file system answers EINVAL.
  std::size_t read_some(int descriptor, std::uint64_t offset, std::span<std::byte> into, bool* refused = nullptr);
  [[noreturn]] void throw_refused() const;
  [[noreturn]] void throw_short(std::uint64_t offset, std::uint64_t count, std::uint64_t end) const;

  std::string path_;
  DirectIo mode_;
  Descriptor buffered_;
  Descriptor direct_;  ///< -1 if direct I/O is off or refused
  std::uint64_t size_ = 0;
  FileState state_;
  std::byte* mapping_ = nullptr;  ///< mapping of the whole file, for mincore only: never dereferenced
  std::atomic<bool> direct_works_{false};
  std::atomic<std::uint64_t> bytes_read_{0};
};

}  // namespace weir
