// The directory of a region's chunk (FORMAT.md, "Packed data"), which tells where the stream of a block lies. Each
// look-up checks what it reads; no earlier check of the chunk is needed. The bytes may be a mapping or read from a
// file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "format/base/index.h"
#include "format/nanovdb/nvdb_bytes.h"
#include "format/packed/block_constants.h"

namespace weir {

/// Returns the position of a block in its region, x<<8 | y<<4 | z. `block` is a voxel / 8, rounded down.
constexpr unsigned packed_position(const Index3& block) {
  return static_cast<unsigned>((block.x & 15) << 8 | (block.y & 15) << 4 | (block.z & 15));
}

/// The inverse of packed_position(): 0 <= x, y, z < 16.
constexpr Index3 packed_block(unsigned position) { return {position >> 8U, position >> 4U & 15U, position & 15U}; }

/// The place of 16 blocks along z: offsets from the chunk's start.
struct PackedGroup {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  std::uint32_t mask = 0;  ///< bit b: the block at position 16 g + b has a stream

  bool has(unsigned bit) const { return (mask >> bit & 1U) != 0; }
};

/// Returns the range of the means in a chunk. `head` begins at the chunk's first byte and holds at least its fixed
/// part, 1548 bytes. Throws Error(input).
MeanRange packed_means(const NvdbBytes& head);

/// Returns the group of the 16 blocks from position 16 * `group` on, group < 256, of a chunk of `chunk_bytes`. `head`
/// is as for packed_means(). Throws Error(input) if the group does not lie in the chunk.
PackedGroup packed_group(const NvdbBytes& head, std::uint64_t chunk_bytes, unsigned group);

/// Returns the stream of block `bit` of 16; empty only if the block has none. `bytes` are those of the group from its
/// begin to its end. Throws Error(input) if the stream does not lie in the group.
std::span<const std::byte> packed_stream(const NvdbBytes& bytes, const PackedGroup& group, unsigned bit);

}  // namespace weir
