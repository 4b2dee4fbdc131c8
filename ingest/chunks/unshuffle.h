// Undoes the shuffle filter of HDF5 and numcodecs, which stores the bytes of values plane by plane.
#pragma once

#include <cstddef>
#include <span>

namespace weir {

/// Puts the bytes of values of `value_bytes` each, stored plane by plane, back together. Bytes beyond the last whole
/// value are at the end of both spans. `values` is as long as `planes` and does not overlap it; value_bytes >= 1.
void unshuffle(std::span<const std::byte> planes, std::size_t value_bytes, std::span<std::byte> values);

}  // namespace weir
