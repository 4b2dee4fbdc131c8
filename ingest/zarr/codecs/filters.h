// The filters of numcodecs that Zarr arrays of version 2 go through before they are packed.
#pragma once

#include <cstddef>
#include <span>

#include "ingest/zarr/metadata/zarr_array.h"

namespace weir {

/// Undoes `filter` on `bytes`, a multiple of its values' size: shuffle from `bytes` into `other`, which is as long and
/// does not overlap it; delta in place, each value the sum of those up to it, in the values' own type, integers modulo
/// 2^bits (numcodecs.Shuffle, numcodecs.Delta). Returns which of the two has the result.
std::span<std::byte> undo_filter(const ZarrFilter& filter, std::span<std::byte> bytes, std::span<std::byte> other);

}  // namespace weir
