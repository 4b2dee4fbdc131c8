#include "format/nanovdb/packed_chunk.h"

#include <bit>
#include <cmath>

#include "format/packed/packed_layout.h"

namespace weir {

MeanRange packed_means(const NvdbBytes& head) {
  const MeanRange means{head.get<float>(packed::chunk::kMeanLow), head.get<float>(packed::chunk::kMeanHigh)};
  if (!(std::isfinite(means.low) && std::isfinite(means.high) && means.low <= means.high)) {
    head.fail(packed::chunk::kMeanLow, "the range of means is ", means.low, " to ", means.high,
              ", not one of finite values");
  }
  return means;
}

PackedGroup packed_group(const NvdbBytes& head, std::uint64_t chunk_bytes, unsigned group) {
  const std::uint64_t at = packed::chunk::kBases + 4 * std::uint64_t{group};
  const PackedGroup found{head.get<std::uint32_t>(at), head.get<std::uint32_t>(at + 4),
                          head.get<std::uint16_t>(packed::chunk::kMasks + 2 * std::uint64_t{group})};
  if (found.begin < packed::chunk::kGroups || found.begin > found.end || found.end > chunk_bytes) {
    head.fail(at, "group ", group, " of blocks lies in bytes ", found.begin, " to ", found.end,
              " of a chunk whose groups lie in bytes ", packed::chunk::kGroups, " to ", chunk_bytes);
  }
  const std::uint64_t directory = packed::chunk::kEndBytes * static_cast<std::uint64_t>(std::popcount(found.mask));
  if (found.end - found.begin < directory) {
    head.fail(at, "group ", group, " of blocks has ", found.end - found.begin, " bytes, its directory alone ",
              directory);
  }
  return found;
}

std::span<const std::byte> packed_stream(const NvdbBytes& bytes, const PackedGroup& group, unsigned bit) {
  if (!group.has(bit)) return {};
  const auto streams = static_cast<std::uint64_t>(std::popcount(group.mask));
  const auto before = static_cast<std::uint64_t>(std::popcount(group.mask & ((1U << bit) - 1U)));
  const std::uint64_t at = packed::chunk::kEndBytes * before;
  const std::uint64_t first = packed::chunk::kEndBytes * streams;
  const std::uint64_t begin = before == 0 ? first : bytes.get<std::uint16_t>(at - packed::chunk::kEndBytes);
  const std::uint64_t end = bytes.get<std::uint16_t>(at);
  if (begin < first || begin >= end || end > bytes.size()) {
    bytes.fail(at, "stream ", before, " of ", streams, " lies in bytes ", begin, " to ", end,
               " of a group whose streams lie in bytes ", first, " to ", bytes.size());
  }
  return {bytes.at(begin), end - begin};
}

}  // namespace weir
