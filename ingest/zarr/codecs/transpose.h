// Chunks whose axes are stored in another order than the array's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace weir {

/// Puts the values of a chunk of `extent` elements, slowest axis first, of `value_bytes` each, into that order. Axis i
/// of `stored` is axis order[i] of the chunk. `values` is as long as `stored` and does not overlap it.
void undo_transpose(std::span<const std::byte> stored, std::span<const std::int64_t> extent,
                    std::span<const std::size_t> order, std::size_t value_bytes, std::span<std::byte> values);

}  // namespace weir
