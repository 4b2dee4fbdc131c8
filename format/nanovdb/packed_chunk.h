// The directory of a region's chunk (FORMAT.md, "Packed data"): where the stream of a block lies. Each look-up checks
// what it reads; a chunk need not have been looked at before. Bytes may be a mapping or what was read of a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "format/base/index.h"
#include "format/nanovdb/nvdb_bytes.h"
#include "format/packed/block_constants.h"

namespace weir {

/// Position of a block in its region, x<<8 | y<<4 | z; `block`: voxel / 8, rounded down.
constexpr unsigned packed_position(const Index3& block) {
  return static_cast<unsigned>((block.x & 15) << 8 | (block.y & 15) << 4 | (block.z & 15));
}

/// Inverse: 0 <= x, y, z < 16.
constexpr Index3 packed_block(unsigned position) { return {position >> 8U, position >> 4U & 15U, position & 15U}; }

/// Where 16 blocks along z lie: offsets from the chunk's start.
struct PackedGroup {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  std::uint32_t mask = 0;  ///< bit b: the block at position 16 g + b has a stream

  bool has(unsigned bit) const { return (mask >> bit & 1U) != 0; }
};

/// The range of the means in a chunk. `head` begins at the chunk's first byte and holds its fixed part, 1548 bytes at
/// least. Throws Error(input).
MeanRange packed_means(const NvdbBytes& head);

/// The group of the blocks at positions 16 `group` and up, group < 256, of a chunk of `chunk_bytes`. `head` as above.
/// Throws Error(input) where it does not lie in the chunk.
PackedGroup packed_group(const NvdbBytes& head, std::uint64_t chunk_bytes, unsigned group);

/// The stream of block `bit` of 16; empty where it has none, else not. `bytes` are those of the group from its begin
/// to its end. Throws Error(input) where the stream does not lie in the group.
std::span<const std::byte> packed_stream(const NvdbBytes& bytes, const PackedGroup& group, unsigned bit);

}  // namespace weir
