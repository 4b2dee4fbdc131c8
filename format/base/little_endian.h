// Access to fields at byte offsets of a little-endian image. weir runs on little-endian machines only; a static_assert
// checks it.
#pragma once

#include <bit>
#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>

namespace weir {

static_assert(std::endian::native == std::endian::little,
              "NanoVDB files are little endian; add swaps for this machine");

/// Writes `value` at `offset` of `image`, which must be large enough.
template <typename T>
void store(std::span<std::byte> image, std::size_t offset, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::memcpy(image.data() + offset, &value, sizeof(T));
}

/// Reads a T at `offset` of `image`, which must be large enough; needs no alignment.
template <typename T>
T load(std::span<const std::byte> image, std::size_t offset) {
  static_assert(std::is_trivially_copyable_v<T>);
  T value;
  std::memcpy(&value, image.data() + offset, sizeof(T));
  return value;
}

}  // namespace weir
