// Undoes the transposition of a chunk: its axes are stored in an order other than the array's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace weir {

/// Copies the values of a chunk from `stored` to `values`, in the chunk's own order. The chunk has `extent` elements,
/// slowest axis first, of `value_bytes` bytes each. Axis i of `stored` is axis order[i] of the chunk. `values` is as
/// long as `stored` and does not overlap it.
void undo_transpose(std::span<const std::byte> stored, std::span<const std::int64_t> extent,
                    std::span<const std::size_t> order, std::size_t value_bytes, std::span<std::byte> values);

}  // namespace weir
