#include "compressor/select/file_size.h"

#include <array>
#include <charconv>
#include <limits>
#include <string_view>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {

// The decimal digits count because 2.3 in binary is a little less than 2.3, and 92 bytes would become 41. Integers,
// because dense_bytes may exceed 2^53.
std::uint64_t bytes_at_rate(std::uint64_t dense_bytes, double rate) {
  std::array<char, 32> text{};
  std::to_chars(text.data(), text.data() + text.size(), rate, std::chars_format::scientific);  // "2.3e+00"
  const std::string_view number(text.data());
  const std::size_t e = number.find('e');
  std::uint64_t digits = 0;  // rate = digits * 10^power; 17 at most
  int power = 0;
  std::from_chars(&number[e + (number[e + 1] == '+' ? 2 : 1)], number.data() + number.size(), power);
  for (std::size_t i = 0; i < e; ++i) {
    if (number[i] == '.') continue;
    digits = digits * 10 + static_cast<std::uint64_t>(number[i] - '0');
    if (i > 0) --power;
  }
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t quotient = dense_bytes / digits;
  std::uint64_t remainder = dense_bytes % digits;
  for (; power < 0; ++power) {  // long division
    if (quotient > kMost / 10 - 1) return kMost;
    quotient = quotient * 10 + remainder * 10 / digits;
    remainder = remainder * 10 % digits;
  }
  for (; power > 0 && quotient > 0; --power) {
    remainder += quotient % 10;  // from here on it only matters whether it is 0
    quotient /= 10;
  }
  return quotient + (remainder > 0 ? 1 : 0);
}

std::uint64_t asked_bytes(const Budget& budget, std::uint64_t dense_bytes) {
  return budget.kind == Budget::Kind::size ? budget.bytes : bytes_at_rate(dense_bytes, budget.rate);
}

FileSize file_size_for(const Budget& budget, std::uint64_t dense_bytes, const SelectionBytes& bytes,
                       const std::string& path) {
  const std::uint64_t minimum = bytes.minimum.file_bytes;
  const std::uint64_t full = bytes.full.file_bytes;
  FileSize size;
  switch (budget.kind) {
    case Budget::Kind::lossless:
      return {full, "lossless", ""};
    case Budget::Kind::psnr:
    case Budget::Kind::max_error:
      throw Error(ErrorKind::internal, "an error target has no size of its own");
    case Budget::Kind::automatic:
      size = {bytes_at_rate(dense_bytes, budget.rate), "rate", ""};
      if (size.bytes < minimum) {
        return {minimum, "minimum",
                compose(path, ": ", option("rate", budget.rate), " would be ", size.bytes,
                        size.bytes == 1 ? " byte" : " bytes", ", less than the smallest possible file, ", minimum,
                        " bytes; writing that")};
      }
      break;
    case Budget::Kind::rate:
      size = {bytes_at_rate(dense_bytes, budget.rate), "rate", ""};
      break;
    case Budget::Kind::size:
      size = {budget.bytes, "size", ""};
      break;
  }
  if (size.bytes < minimum) {
    throw Error(ErrorKind::budget,
                compose(path, ": ", size.bytes, " bytes asked, the smallest tree for this volume takes ", minimum,
                        "; ask for ", option("size", minimum), " or more"));
  }
  if (size.bytes > full) {
    const char* all = bytes.by_scene            ? ": what the scene shows takes no more than "
                      : bytes.lossy_leaves == 0 ? ": lossless takes "
                                                : ": the best that this encoding can do takes ";
    if (budget.at_most) {
      const char* kept = bytes.by_scene            ? ": all that the scene shows in "
                         : bytes.lossy_leaves == 0 ? ": lossless in "
                                                   : ": the best that this encoding can do, in ";
      size.notice = compose(path, kept, full, " bytes; ", size.bytes, " were allowed").as_remark();
      size.bytes = full;
    } else {
      size.notice = compose(path, all, full, " bytes; the other ", size.bytes - full, " of the ", size.bytes,
                            " asked are padding, which ", option("at-most"), " leaves out");
    }
  }
  return size;
}

}  // namespace weir
