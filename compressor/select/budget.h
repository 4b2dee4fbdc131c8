// What size, or what error, was asked for.
#pragma once

#include <cstdint>

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

}  // namespace weir
