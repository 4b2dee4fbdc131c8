#include "ingest/hdf5/filters/undo_filters.h"

#include <algorithm>
#include <cstdint>
#include <string_view>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {

namespace {

constexpr std::size_t kFirstRepeat = 32;  // smaller control bytes count literals
constexpr std::size_t kLongRepeat = 7;    // the length continues in the next byte
constexpr std::size_t kShortest = 2;      // added to the stated length of a repeat

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
      // Copies byte by byte, because the repeated bytes may overlap the bytes being written.
      for (std::size_t i = 0; i < count; ++i) bytes[out + i] = bytes[out + i - back];
    }
    out += count;
  }
  if (out != bytes.size()) throw damaged("ends");
}

namespace {

/// The words that are summed before the sums are reduced. The second sum stays below 2^47.
constexpr std::size_t kWordsAtATime = 32768;

/// Returns the ones' complement remainder. Ones' complement has two zeros; only a sum of zeros alone gives 0.
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
  // On little-endian machines, HDF5 before 1.6.3 stored the two bytes of each half in reversed order.
  const std::uint32_t reversed = (computed & 0x00FF00FFU) << 8U | (computed >> 8U & 0x00FF00FFU);
  if (stored != computed && stored != reversed) {
    throw Error(ErrorKind::input, cat("its checksum is ", stored, ", its bytes give ", computed));
  }
  return checked;
}

}  // namespace weir
