// The codecs that a chunk of a Zarr array has gone through, and their undoing in memory of known size.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ingest/chunks/chunk_scratch.h"
#include "ingest/zarr/metadata/zarr_array.h"

namespace weir {

/// A chunk before its codecs.
struct ChunkShape {
  std::vector<std::int64_t> extent;  ///< elements, slowest axis first, each >= 1
  std::size_t value_bytes = 1;       ///< 1, 2, 4 or 8

  std::size_t bytes() const;
};

/// The most bytes that a chunk can take at any stage of `codecs`: the size of the buffers of decode_chunk, and of what
/// is stored.
std::size_t most_stored_bytes(const ZarrCodecs& codecs, std::size_t chunk_bytes);

/// The scratch that decode_chunk takes.
ScratchSize scratch_size(const ZarrCodecs& codecs, std::size_t chunk_bytes);

/// Undoes the codecs of one chunk, whose first `stored` bytes of scratch.buffer are as they were stored, and returns
/// its shape.bytes() bytes, the last axis fastest, which lie in `scratch`. Throws Error(input), without a place, where
/// a codec fails or the size is another one in the end.
std::span<const std::byte> decode_chunk(const ZarrCodecs& codecs, const ChunkShape& shape, std::size_t stored,
                                        ChunkScratch& scratch);

}  // namespace weir
