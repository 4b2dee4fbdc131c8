// A range of bytes of a file, and the function that reads several ranges at once from wherever the file lies.
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

/// Reads each of `ranges` into the buffer of `into` at the same position, which has the range's length. It makes one
/// request for each, in any order. Throws Error if a range cannot be read whole.
using RangeReader = std::function<void(std::span<const ByteRange> ranges, std::span<const std::span<std::byte>> into)>;

}  // namespace weir
