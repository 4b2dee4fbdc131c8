// Decodes a chunk of a Zarr array: undoes its codecs in memory of known size.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ingest/chunks/chunk_scratch.h"
#include "ingest/zarr/metadata/zarr_array.h"

namespace weir {

/// The shape of a chunk before its codecs are applied.
struct ChunkShape {
  std::vector<std::int64_t> extent;  ///< elements, slowest axis first, each >= 1
  std::size_t value_bytes = 1;       ///< 1, 2, 4 or 8

  std::size_t bytes() const;
};

/// Returns the most bytes that a chunk can take at any stage of `codecs`, its stored form included. decode_chunk's
/// buffers have this size.
std::size_t most_stored_bytes(const ZarrCodecs& codecs, std::size_t chunk_bytes);

/// Returns the scratch memory that decode_chunk needs.
ScratchSize scratch_size(const ZarrCodecs& codecs, std::size_t chunk_bytes);

/// Undoes the codecs of one chunk. Its stored bytes are the first `stored` bytes of scratch.buffer. Returns the
/// chunk's shape.bytes() bytes, the last axis fastest; they lie in `scratch`. Throws Error(input), with no place in
/// its message, if a codec fails or the decoded size is not shape.bytes().
std::span<const std::byte> decode_chunk(const ZarrCodecs& codecs, const ChunkShape& shape, std::size_t stored,
                                        ChunkScratch& scratch);

}  // namespace weir
