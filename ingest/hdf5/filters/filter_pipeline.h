// Describes the filters of a dataset's chunks and undoes them: the filters that every HDF5 library has and that most
// files use, and h5py's lzf.
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ingest/chunks/chunk_inflater.h"

namespace weir {

enum class FilterKind { deflate, lzf, shuffle, fletcher32 };

struct ChunkFilter {
  FilterKind kind = FilterKind::deflate;
  std::size_t value_bytes = 1;  ///< of shuffle
};

/// Filters in the order of writing. At most one is deflate or lzf, so all sizes in between are known.
using FilterPipeline = std::vector<ChunkFilter>;

/// The filters that a chunk's mask marks as left out: bit i for filter i.
using FilterMask = std::uint32_t;
inline constexpr FilterMask kAllLeftOut = ~FilterMask{0};

/// Returns the pipeline of a dataset's creation properties; nullopt if a filter is not among FilterKind, or if
/// deflate and lzf occur twice. The caller holds Hdf5Lock.
std::optional<FilterPipeline> own_pipeline(hid_t creation_properties);

/// Returns the most bytes that a chunk of `chunk_bytes` can take at any stage of `pipeline`: the size of both buffers
/// of undo_filters(). chunk_bytes < 2^32 - 2^25.
std::size_t most_stored_bytes(const FilterPipeline& pipeline, std::size_t chunk_bytes);

/// Returns whether undo_filters() writes to `other` at all.
bool needs_other_buffer(const FilterPipeline& pipeline);

/// Undoes the filters of one chunk. The first `stored` bytes of `buffer` are the chunk as the file stores it. Returns
/// the chunk's `chunk_bytes` bytes, in `buffer` or in `other`; both have most_stored_bytes() bytes. Throws
/// Error(input), without a place, if a filter fails or the final size is not `chunk_bytes`.
std::span<const std::byte> undo_filters(const FilterPipeline& pipeline, FilterMask left_out, std::size_t chunk_bytes,
                                        std::size_t stored, std::span<std::byte> buffer, std::span<std::byte> other,
                                        ChunkInflater& inflater);

}  // namespace weir
