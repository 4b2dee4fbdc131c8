// The packed data of a grid in device memory, as kernels see it (FORMAT.md, "Packed data"). A look-up checks what it
// reads, as format/nanovdb/packed_chunk.h does for file readers. For host and device.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/block_constants.h"
#include "format/packed/packed_layout.h"
#include "gpu/volume/block_lattice.h"

namespace weir {

struct PackedView {
  const std::byte* data = nullptr;  ///< at a multiple of 16; readable up to the next multiple of 16
  std::uint64_t bytes = 0;
  std::uint64_t table = 0;    ///< offset of the region table
  std::uint64_t regions = 0;  ///< number of entries of the region table, x fastest
  BlockConstants constants;   ///< with tables on the device
};

/// The result of looking up a block.
struct FoundStream {
  const std::byte* data = nullptr;  ///< null: the block has no stream
  std::uint32_t bytes = 0;
  MeanRange means;
  float value = 0;  ///< value of a block without a stream
  bool damaged = false;
};

namespace packed_detail {

// `at` may have any alignment.
WEIR_HOST_DEVICE inline std::uint32_t load_u16(const std::byte* at) {
  return static_cast<std::uint32_t>(at[0]) | static_cast<std::uint32_t>(at[1]) << 8U;
}

template <class T>
WEIR_HOST_DEVICE T load_aligned(const std::byte* at) {
  return *reinterpret_cast<const T*>(at);
}

}  // namespace packed_detail

WEIR_HOST_DEVICE inline FoundStream find_stream(const PackedView& view, BlockId id) {
  using namespace packed_detail;
  FoundStream found;
  found.damaged = true;
  const std::uint64_t region = id >> 12U;
  if (region >= view.regions) return found;
  const std::byte* entry = view.data + view.table + region * packed::region::kEntryBytes;
  const auto offset = load_aligned<std::uint64_t>(entry + packed::region::kChunk);
  const auto chunk_bytes = load_aligned<std::uint32_t>(entry + packed::region::kChunkBytes);
  found.value = load_aligned<float>(entry + packed::region::kValue);
  if (offset == 0) {
    found.damaged = false;
    return found;
  }
  if (offset % packed::chunk::kAlignment != 0 || offset > view.bytes || chunk_bytes > view.bytes - offset ||
      chunk_bytes < packed::chunk::kGroups) {
    return found;
  }
  const std::byte* chunk = view.data + offset;
  const auto group = static_cast<std::uint32_t>(id >> 4U & 255U);
  const auto bit = static_cast<std::uint32_t>(id & 15U);
  const auto mask = load_aligned<std::uint16_t>(chunk + packed::chunk::kMasks + 2 * group);
  if ((mask >> bit & 1U) == 0) {
    found.damaged = false;
    return found;
  }
  found.means = {load_aligned<float>(chunk + packed::chunk::kMeanLow),
                 load_aligned<float>(chunk + packed::chunk::kMeanHigh)};
  const auto begin = load_aligned<std::uint32_t>(chunk + packed::chunk::kBases + 4 * group);
  const auto end = load_aligned<std::uint32_t>(chunk + packed::chunk::kBases + 4 * group + 4);
  const auto streams = static_cast<std::uint32_t>(__builtin_popcount(mask));
  const auto before = static_cast<std::uint32_t>(__builtin_popcount(mask & ((1U << bit) - 1U)));
  if (begin < packed::chunk::kGroups || begin > end || end > chunk_bytes || end - begin < 2 * streams) return found;
  const std::byte* ends = chunk + begin;
  const std::uint32_t first = before == 0 ? 2 * streams : load_u16(ends + 2 * (before - 1));
  const std::uint32_t last = load_u16(ends + 2 * before);
  if (first < 2 * streams || first >= last || last > end - begin) return found;
  found.data = ends + first;
  found.bytes = last - first;
  found.damaged = false;
  return found;
}

}  // namespace weir
