// The numcodecs filters that values of Zarr arrays of version 2 pass through before they are packed.
#pragma once

#include <cstddef>
#include <span>

#include "ingest/zarr/metadata/zarr_array.h"

namespace weir {

/// Undoes `filter` on `bytes`, a multiple of the values' size (numcodecs.Shuffle, numcodecs.Delta). Shuffle is undone
/// from `bytes` into `other`, which is as long and does not overlap `bytes`. Delta is undone in place: each value
/// becomes the sum of the values up to it, in the values' own type, integers modulo 2^bits. Returns the span, `bytes`
/// or `other`, that has the result.
std::span<std::byte> undo_filter(const ZarrFilter& filter, std::span<std::byte> bytes, std::span<std::byte> other);

}  // namespace weir
