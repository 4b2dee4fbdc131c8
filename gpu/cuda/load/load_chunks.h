// The chunks in which a range of a mapped file is page-locked and copied.
#pragma once

#include <cstdint>
#include <vector>

namespace weir {

/// Pages [begin, end) of the mapping. Bytes [copy_begin, copy_end) of them are copied. All are bytes from the
/// mapping's start.
struct LoadChunk {
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
  std::uint64_t copy_begin = 0;
  std::uint64_t copy_end = 0;

  friend bool operator==(const LoadChunk&, const LoadChunk&) = default;
};

/// Covers bytes [offset, offset + bytes) with chunks of whole pages that share no page. The first chunk has an eighth
/// of `chunk_bytes`, and each next one twice the size of the last, so that the first copy starts early. The others
/// have `chunk_bytes` rounded up to pages. Returns nothing if `bytes` is 0. `page` is a power of two.
std::vector<LoadChunk> plan_load_chunks(std::uint64_t offset, std::uint64_t bytes, std::uint64_t page,
                                        std::uint64_t chunk_bytes);

}  // namespace weir
