#include "gpu/cuda/load/load_chunks.h"

#include <algorithm>

namespace weir {

std::vector<LoadChunk> plan_load_chunks(std::uint64_t offset, std::uint64_t bytes, std::uint64_t page,
                                        std::uint64_t chunk_bytes) {
  constexpr std::uint64_t kFirstShare = 8;
  const auto up = [page](std::uint64_t value) { return (value + page - 1) / page * page; };
  const std::uint64_t largest = std::max(up(chunk_bytes), page);
  const std::uint64_t end = offset + bytes;
  std::uint64_t size = std::max(up(largest / kFirstShare), page);
  std::vector<LoadChunk> chunks;
  for (std::uint64_t at = offset / page * page; bytes > 0 && at < end; size = std::min(2 * size, largest)) {
    const std::uint64_t next = std::min(at + size, up(end));
    chunks.push_back({at, next, std::max(at, offset), std::min(next, end)});
    at = next;
  }
  return chunks;
}

}  // namespace weir
