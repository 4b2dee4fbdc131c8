// A stretch of a file, and what reads some of them at once from wherever the file lies.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

namespace weir {

/// Bytes [offset, offset + bytes) of a file.
struct ByteRange {
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;

  std::uint64_t end() const { return offset + bytes; }
  friend bool operator==(const ByteRange&, const ByteRange&) = default;
};

/// Reads each of `ranges` into `into` at the same position, which has its length. One request each; the order is the
/// reader's own. Throws Error where one cannot be read whole.
using RangeReader = std::function<void(std::span<const ByteRange> ranges, std::span<const std::span<std::byte>> into)>;

}  // namespace weir
