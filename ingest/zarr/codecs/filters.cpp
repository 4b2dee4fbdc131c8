#include "ingest/zarr/codecs/filters.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "ingest/chunks/unshuffle.h"

namespace weir {
namespace {

/// Replaces each value by the sum of the values up to it, in the values' type. Unsigned T serves signed integers too,
/// because sums are modulo 2^bits.
template <typename T>
void sum_up(std::span<std::byte> bytes, bool big_endian) {
  const bool swapped = big_endian != (std::endian::native == std::endian::big);
  T sum{};
  for (std::size_t at = 0; at + sizeof(T) <= bytes.size(); at += sizeof(T)) {
    std::array<std::byte, sizeof(T)> value;
    const std::span<std::byte> stored = bytes.subspan(at, sizeof(T));
    std::ranges::copy(stored, value.begin());
    if (swapped) std::ranges::reverse(value);
    // The first value is copied, not added to 0: 0 + -0 would be 0.
    sum = at == 0 ? std::bit_cast<T>(value) : static_cast<T>(sum + std::bit_cast<T>(value));
    value = std::bit_cast<std::array<std::byte, sizeof(T)>>(sum);
    if (swapped) std::ranges::reverse(value);
    std::ranges::copy(value, stored.begin());
  }
}

void undo_delta(const ZarrFilter& filter, std::span<std::byte> bytes) {
  if (filter.type == ScalarType::float32) return sum_up<float>(bytes, filter.big_endian);
  if (filter.type == ScalarType::float64) return sum_up<double>(bytes, filter.big_endian);
  switch (scalar_bytes(filter.type)) {
    case 1:
      return sum_up<std::uint8_t>(bytes, filter.big_endian);
    case 2:
      return sum_up<std::uint16_t>(bytes, filter.big_endian);
    case 4:
      return sum_up<std::uint32_t>(bytes, filter.big_endian);
    default:
      return sum_up<std::uint64_t>(bytes, filter.big_endian);
  }
}

}  // namespace

std::span<std::byte> undo_filter(const ZarrFilter& filter, std::span<std::byte> bytes, std::span<std::byte> other) {
  if (filter.kind == ZarrFilter::Kind::delta) {
    undo_delta(filter, bytes);
    return bytes;
  }
  unshuffle(bytes, filter.value_bytes, other);
  return other;
}

}  // namespace weir
