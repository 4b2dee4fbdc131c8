#include "compressor/budget.h"

#include <cmath>

#include "format/error.h"
#include "format/text.h"

namespace weir {
namespace {

std::uint64_t bytes_at_rate(std::uint64_t dense_bytes, double rate) {
  // Whole rates by integers: exact beyond 2^53 bytes too.
  if (rate == std::floor(rate) && rate < 0x1p53) {
    const auto whole = static_cast<std::uint64_t>(rate);
    return dense_bytes / whole + (dense_bytes % whole != 0 ? 1 : 0);
  }
  return static_cast<std::uint64_t>(std::ceil(static_cast<long double>(dense_bytes) / static_cast<long double>(rate)));
}

}  // namespace

FileSize file_size_for(const Budget& budget, std::uint64_t dense_bytes, const SelectionBytes& bytes,
                       const std::string& path) {
  const std::uint64_t minimum = bytes.minimum.file_bytes;
  const std::uint64_t lossless = bytes.lossless.file_bytes;
  FileSize size;
  switch (budget.kind) {
    case Budget::Kind::lossless:
      return {lossless, "lossless", ""};
    case Budget::Kind::automatic:
      size = {bytes_at_rate(dense_bytes, budget.rate), "rate", ""};
      if (size.bytes < minimum) {
        return {minimum, "minimum",
                cat(path, ": --rate 8 would be ", size.bytes,
                    " bytes, less than the smallest tree; writing that: ", minimum, " bytes")};
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
    throw Error(ErrorKind::budget, cat(path, ": ", size.bytes, " bytes asked, the smallest tree for this volume takes ",
                                       minimum, "; ask for --size ", minimum, " or more"));
  }
  if (size.bytes > lossless) {
    size.notice = cat(path, ": lossless takes ", lossless, " bytes; the other ", size.bytes - lossless, " of the ",
                      size.bytes, " asked are padding");
  }
  return size;
}

}  // namespace weir
