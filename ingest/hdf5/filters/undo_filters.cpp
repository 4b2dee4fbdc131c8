#include "ingest/hdf5/filters/undo_filters.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {

namespace {

constexpr std::size_t kFirstRepeat = 32;  // smaller ones count literals
constexpr std::size_t kLongRepeat = 7;    // its length goes on in a byte of its own
constexpr std::size_t kShortest = 2;      // repeats are this much longer than they say

}  // namespace

void unpack_lzf(std::span<const std::byte> stream, std::span<std::byte> bytes) {
  std::size_t in = 0;
  std::size_t out = 0;
  const auto damaged = [&](std::string_view what) {
    return Error(ErrorKind::input, cat("its lzf stream ", what, " after ", out, " of ", bytes.size(), " bytes"));
  };
  const auto next = [&] {
    if (in == stream.size()) throw damaged("is cut");
    return std::to_integer<std::size_t>(stream[in++]);
  };
  while (in < stream.size()) {
    const std::size_t control = next();
    const bool literal = control < kFirstRepeat;
    std::size_t count = literal ? control + 1 : control >> 5U;
    if (count == kLongRepeat && !literal) count += next();
    if (!literal) count += kShortest;
    if (count > bytes.size() - out) throw damaged("holds more");
    if (literal) {
      if (count > stream.size() - in) throw damaged("is cut");
      std::copy_n(stream.begin() + static_cast<std::ptrdiff_t>(in), count,
                  bytes.begin() + static_cast<std::ptrdiff_t>(out));
      in += count;
    } else {
      const std::size_t back = ((control % kFirstRepeat) << 8U) + next() + 1;
      if (back > out) throw damaged("repeats what is not there");
      // Byte by byte: what is repeated may reach into what it becomes.
      for (std::size_t i = 0; i < count; ++i) bytes[out + i] = bytes[out + i - back];
    }
    out += count;
  }
  if (out != bytes.size()) throw damaged("ends");
}

namespace {

/// Values put together at a time by unshuffle_any: one cache line of each plane.
constexpr std::size_t kTileValues = 64;

/// Bits byte j of a value is shifted by to lie in memory at j.
template <typename Word>
constexpr int shift_of(std::size_t j) {
  const std::size_t place = std::endian::native == std::endian::little ? j : sizeof(Word) - 1 - j;
  return static_cast<int>(8 * place);
}

/// Whole words, so that the compiler widens and merges planes in vector registers.
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

namespace {

/// Words summed before the sums are reduced: the second one stays below 2^47.
constexpr std::size_t kWordsAtATime = 32768;

/// The remainder of ones' complement, which has two zeros: only a sum of nothing but zeros is 0.
std::uint64_t reduce(std::uint64_t sum) { return sum == 0 ? 0 : (sum - 1) % 0xFFFFU + 1; }

}  // namespace

std::uint32_t fletcher32(std::span<const std::byte> bytes) {
  const std::size_t whole = bytes.size() / 2;
  std::uint64_t first = 0;
  std::uint64_t second = 0;
  for (std::size_t start = 0; start < whole; start += kWordsAtATime) {
    const std::size_t end = std::min(start + kWordsAtATime, whole);
    for (std::size_t i = start; i < end; ++i) {
      first += std::to_integer<std::uint64_t>(bytes[2 * i]) << 8U | std::to_integer<std::uint64_t>(bytes[2 * i + 1]);
      second += first;
    }
    first = reduce(first);
    second = reduce(second);
  }
  if (bytes.size() % 2 == 1) {
    first = reduce(first + (std::to_integer<std::uint64_t>(bytes.back()) << 8U));
    second = reduce(second + first);
  }
  return static_cast<std::uint32_t>(second << 16U | first);
}

std::span<std::byte> check_fletcher32(std::span<std::byte> bytes) {
  if (bytes.size() < kFletcher32Bytes) {
    throw Error(ErrorKind::input, cat("holds ", bytes.size(), " bytes, fewer than its checksum takes"));
  }
  const std::span<std::byte> checked = bytes.first(bytes.size() - kFletcher32Bytes);
  std::uint32_t stored = 0;
  for (std::size_t i = 0; i < kFletcher32Bytes; ++i) {
    stored |= std::to_integer<std::uint32_t>(bytes[checked.size() + i]) << (8 * i);
  }
  const std::uint32_t computed = fletcher32(checked);
  // HDF5 before 1.6.3 stored the two bytes of each half the other way round on little-endian machines.
  const std::uint32_t reversed = (computed & 0x00FF00FFU) << 8U | (computed >> 8U & 0x00FF00FFU);
  if (stored != computed && stored != reversed) {
    throw Error(ErrorKind::input, cat("its checksum is ", stored, ", its bytes give ", computed));
  }
  return checked;
}

}  // namespace weir
