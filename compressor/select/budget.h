// The size that was asked for, and the size the file will have.
#pragma once

#include <cstdint>
#include <string>

#include "compressor/select/selection.h"

namespace weir {

struct Budget {
  enum class Kind {
    automatic,  ///< --rate 8, or the minimum tree where that is larger
    size,       ///< `value` bytes
    rate,       ///< ceil(float32 bytes of the volume / `value`)
    psnr,       ///< as few bytes as keep the PSNR at `target` dB or above
    max_error,  ///< as few bytes as keep every voxel within `target` of its value
    lossless    ///< as many bytes as every bit needs
  };
  Kind kind = Kind::automatic;
  double rate = 8;          ///< finite, > 0; its shortest decimal form counts
  std::uint64_t bytes = 0;  ///< for Kind::size
  double target = 0;        ///< for Kind::psnr, dB, finite; for Kind::max_error, >= 0

  /// The size follows from the error, not the error from the size.
  bool by_error() const { return kind == Kind::psnr || kind == Kind::max_error; }
};

/// "rate", "size", "psnr", "max_error", "lossless" or "minimum": the sidecar's budget.kind.
struct FileSize {
  std::uint64_t bytes = 0;
  std::string kind;
  std::string notice;  ///< one line for the user where the size is not what was asked, or pads a lot; may be empty
};

/// ceil(dense_bytes / rate), exact for the decimal number that `rate` was written as.
std::uint64_t bytes_at_rate(std::uint64_t dense_bytes, double rate);

/// Exact file size for a budget that is not by error. Throws Error(budget) naming the minimum where it is below that.
FileSize file_size_for(const Budget& budget, std::uint64_t dense_float32_bytes, const SelectionBytes& bytes,
                       const std::string& path);

}  // namespace weir
