// A remote file as a span of its whole length that holds only the parts that were fetched. Address space is reserved
// for the whole file; only the parts that were read take memory. So the readers of files in memory also read remote
// files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "format/remote/byte_range.h"

namespace weir {

class FetchedBytes {
 public:
  /// Throws Error(io) if the system has no address space for `bytes` (more than 0).
  FetchedBytes(std::uint64_t bytes, RangeReader reader);
  ~FetchedBytes();
  FetchedBytes(const FetchedBytes&) = delete;
  FetchedBytes& operator=(const FetchedBytes&) = delete;

  /// Returns the whole file; bytes that were not fetched are 0.
  std::span<const std::byte> bytes() const { return bytes_; }

  /// Returns whether all of `range` is fetched.
  bool has(const ByteRange& range) const;
  /// Reads the parts of `ranges` that are not fetched yet, some 64 MiB at a time. `ranges` lie in the file and do not
  /// overlap. Throws as the reader; parts fetched before, also in this call, then remain.
  void fetch(const std::vector<ByteRange>& ranges);
  /// Adds bytes that were read by other means.
  void put(std::uint64_t offset, std::span<const std::byte> bytes);
  /// Returns the number of bytes that are held.
  std::uint64_t held() const { return held_; }
  /// Forgets the bytes from `offset` on, and frees their memory in whole pages.
  void forget_from(std::uint64_t offset);

 private:
  void add(const ByteRange& range);

  std::span<std::byte> bytes_;
  RangeReader reader_;
  std::map<std::uint64_t, std::uint64_t> there_;  // begin to end, apart from each other; the parts that are held
  std::uint64_t held_ = 0;
};

}  // namespace weir
