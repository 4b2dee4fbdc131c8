// The budget of a conversion: the size or the error that was asked for.
#pragma once

#include <cstdint>
#include <string>

namespace weir {

/// PSNR in dB that a small volume keeps at least if no budget is given. A lower PSNR is reported as a poor result.
inline constexpr double kDefaultLeastDb = 40;

struct Budget {
  enum class Kind {
    automatic,  ///< --rate 8, or the minimum tree if larger; `target` says what happens if it keeps too little
    size,       ///< `bytes`
    rate,       ///< ceil(float32 bytes of the volume / `rate`)
    psnr,       ///< as few bytes as keep the PSNR at `target` dB or above
    max_error,  ///< as few bytes as keep every voxel within `target` of its value
    lossless    ///< as many bytes as every bit needs
  };
  Kind kind = Kind::automatic;
  double rate = 8;          ///< finite, > 0; its shortest decimal form counts
  std::uint64_t bytes = 0;  ///< for Kind::size
  /// For Kind::psnr: dB, finite. For Kind::max_error: >= 0. For Kind::automatic: dB; a file that keeps less is replaced
  /// by a lossless file if that is smaller than the volume as float32, otherwise by a file that keeps `target`. 0: the
  /// file is never replaced.
  double target = 0;
  /// For Kind::size and Kind::rate: if the volume needs less, the file is shorter, not padded.
  bool at_most = false;

  bool by_size() const { return kind == Kind::size || kind == Kind::rate; }
  /// The size follows from the error, not the error from the size.
  bool by_error() const { return kind == Kind::psnr || kind == Kind::max_error; }
};

/// Returns the whole budget as text for comparisons. Budgets that differ in the last digit have different texts.
std::string budget_text(const Budget& budget);

}  // namespace weir
