// The filters that chunks of a dataset have gone through, and their undoing: the
// ones that every HDF5 library has and that most files use, and h5py's own.
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

/// In the order they are applied on writing. At most one is deflate or lzf: all sizes in between are known then.
using FilterPipeline = std::vector<ChunkFilter>;

/// Filters a chunk's mask says were left out: bit i for filter i.
using FilterMask = std::uint32_t;
inline constexpr FilterMask kAllLeftOut = ~FilterMask{0};

/// The pipeline of a dataset's creation properties; nullopt where a filter is not among FilterKind or
/// deflate and lzf occur twice. The caller holds Hdf5Lock.
std::optional<FilterPipeline> own_pipeline(hid_t creation_properties);

/// The most bytes a chunk of `chunk_bytes` can take at any stage of `pipeline`: the size of both buffers
/// that undo_filters works between. chunk_bytes < 2^32 - 2^25.
std::size_t most_stored_bytes(const FilterPipeline& pipeline, std::size_t chunk_bytes);

/// Whether undo_filters writes to `other` at all.
bool needs_other_buffer(const FilterPipeline& pipeline);

/// Undoes the filters of one chunk, whose first `stored` bytes of `buffer` are as they lie in the file, and
/// returns its chunk_bytes bytes, which lie in `buffer` or `other`, both of most_stored_bytes. Throws
/// Error(input), without a place, where a filter fails or the size is not chunk_bytes in the end.
std::span<const std::byte> undo_filters(const FilterPipeline& pipeline, FilterMask left_out, std::size_t chunk_bytes,
                                        std::size_t stored, std::span<std::byte> buffer, std::span<std::byte> other,
                                        ChunkInflater& inflater);

}  // namespace weir
