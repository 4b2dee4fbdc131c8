// A remote file as a span of its whole length, of which only the parts that were asked for are there: address space is
// set aside for all of it, memory is taken by what was read. So the readers of files in memory read remote ones, too.
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
  /// Throws Error(io) where the system has no address space of `bytes`, more than 0.
  FetchedBytes(std::uint64_t bytes, RangeReader reader);
  ~FetchedBytes();
  FetchedBytes(const FetchedBytes&) = delete;
  FetchedBytes& operator=(const FetchedBytes&) = delete;

  /// The whole file; bytes that were not fetched are 0.
  std::span<const std::byte> bytes() const { return bytes_; }

  /// Whether all of `range` is there.
  bool has(const ByteRange& range) const;
  /// Reads `ranges`, which lie in the file and apart from each other, less what is there, some 64 MiB at a time. Throws
  /// as the reader; then what was there, and what was read before, is there.
  void fetch(const std::vector<ByteRange>& ranges);
  /// Adds what was read otherwise.
  void put(std::uint64_t offset, std::span<const std::byte> bytes);
  /// Bytes that are there.
  std::uint64_t held() const { return held_; }
  /// Forgets what lies at `offset` and beyond, and gives its memory back, in whole pages.
  void forget_from(std::uint64_t offset);

 private:
  void add(const ByteRange& range);

  std::span<std::byte> bytes_;
  RangeReader reader_;
  std::map<std::uint64_t, std::uint64_t> there_;  // begin to end, apart from each other
  std::uint64_t held_ = 0;
};

}  // namespace weir
