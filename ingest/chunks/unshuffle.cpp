#include "ingest/chunks/unshuffle.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <utility>

namespace weir {
namespace {

/// Number of values that unshuffle_any puts together at a time: one cache line of each plane.
constexpr std::size_t kTileValues = 64;

/// Returns by how many bits byte j of a value is shifted so that it lies in memory at j.
template <typename Word>
constexpr int shift_of(std::size_t j) {
  const std::size_t place = std::endian::native == std::endian::little ? j : sizeof(Word) - 1 - j;
  return static_cast<int>(8 * place);
}

/// Assembles whole words, so that the compiler widens and merges planes in vector registers.
template <typename Word, std::size_t... J>
void unshuffle_words(const std::byte* planes, std::size_t count, std::byte* values, std::index_sequence<J...>) {
  const std::array<const std::byte*, sizeof...(J)> plane{(planes + J * count)...};
  for (std::size_t i = 0; i < count; ++i) {
    const Word word = static_cast<Word>((... | (std::to_integer<Word>(plane[J][i]) << shift_of<Word>(J))));
    std::memcpy(values + i * sizeof word, &word, sizeof word);
  }
}

template <typename Word>
void unshuffle_words(const std::byte* planes, std::size_t count, std::byte* values) {
  unshuffle_words<Word>(planes, count, values, std::make_index_sequence<sizeof(Word)>());
}

void unshuffle_any(const std::byte* planes, std::size_t count, std::size_t value_bytes, std::byte* values) {
  for (std::size_t first = 0; first < count; first += kTileValues) {
    const std::size_t end = std::min(first + kTileValues, count);
    for (std::size_t j = 0; j < value_bytes; ++j) {
      for (std::size_t i = first; i < end; ++i) values[i * value_bytes + j] = planes[j * count + i];
    }
  }
}

}  // namespace

void unshuffle(std::span<const std::byte> planes, std::size_t value_bytes, std::span<std::byte> values) {
  const std::size_t count = planes.size() / value_bytes;
  switch (value_bytes) {
    case 2:
      unshuffle_words<std::uint16_t>(planes.data(), count, values.data());
      break;
    case 4:
      unshuffle_words<std::uint32_t>(planes.data(), count, values.data());
      break;
    case 8:
      unshuffle_words<std::uint64_t>(planes.data(), count, values.data());
      break;
    default:
      unshuffle_any(planes.data(), count, value_bytes, values.data());
  }
  std::ranges::copy(planes.subspan(count * value_bytes), values.subspan(count * value_bytes).begin());
}

}  // namespace weir
