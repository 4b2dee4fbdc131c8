#include "ingest/hdf5/filters/filter_lzf.h"

#include <algorithm>
#include <string_view>

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

}  // namespace weir
