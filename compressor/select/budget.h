// What size, or what error, was asked for.
#pragma once

#include <cstdint>
#include <string>

namespace weir {

/// What a small volume keeps at least where no budget is given; less is called a poor result.
inline constexpr double kDefaultLeastDb = 40;

struct Budget {
  enum class Kind {
    automatic,  ///< --rate 8, or the minimum tree where that is larger; where that keeps less than `target`, see there
    size,       ///< `bytes`
    rate,       ///< ceil(float32 bytes of the volume / `rate`)
    psnr,       ///< as few bytes as keep the PSNR at `target` dB or above
    max_error,  ///< as few bytes as keep every voxel within `target` of its value
    lossless    ///< as many bytes as every bit needs
  };
  Kind kind = Kind::automatic;
  double rate = 8;          ///< finite, > 0; its shortest decimal form counts
  std::uint64_t bytes = 0;  ///< for Kind::size
  /// For Kind::psnr, dB, finite; for Kind::max_error, >= 0. For Kind::automatic: dB; a file that keeps less gives way
  /// to a lossless one, if that takes less than the volume as float32, else to one that keeps these; 0: none does.
  double target = 0;
  /// For Kind::size and Kind::rate: the file is shorter, not padded, where the volume needs less.
  bool at_most = false;

  bool by_size() const { return kind == Kind::size || kind == Kind::rate; }
  /// The size follows from the error, not the error from the size.
  bool by_error() const { return kind == Kind::psnr || kind == Kind::max_error; }
};

/// All of it, to be compared: what differs in the last digit is another budget.
std::string budget_text(const Budget& budget);

}  // namespace weir
