// What the survey keeps of a block that may be packed: for some steps of the quantiser what its stream takes and what
// error it leaves, so that selection can choose among them. One fixed-size record a block, spilled to disk.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace weir {

/// A share of a block's energy (the squared error of its mean): (1 + m / 1024) * 2^-e, within a part in 2,000.
class ErrorShare {
 public:
  ErrorShare() = default;
  /// Of 0 to 1.
  explicit ErrorShare(double share);
  double value() const {
    if (code_ == kNone) return 0;
    constexpr std::uint64_t kBias = 1023;  // of a double's exponent
    const std::uint64_t e = code_ >> kMantissaBits;
    const std::uint64_t m = code_ & ((1U << kMantissaBits) - 1U);
    return std::bit_cast<double>((kBias - e) << 52U | m << (52U - kMantissaBits));
  }

 private:
  static constexpr int kMantissaBits = 10;
  static constexpr int kLargestExponent = 62;
  static constexpr std::uint16_t kNone = 0xFFFF;
  std::uint16_t code_ = kNone;  // e << 10 | m
};

struct PackedRung {
  std::uint16_t bits = 0;  ///< of the stream but for the code of its mean
  ErrorShare error;        ///< of the block's energy
};

/// Most bits of a mean where every voxel must be within an error: the product of its code and quantum rounds to within
/// a 16th of a quantum.
inline constexpr unsigned kMostBoundedMeanBits = 20;

/// Levels of a block in LeafChoices: 0 no stream, 1 to 22 the rungs of its ladder, from kFirstNearLevel on those that
/// are nearly lossless, kExactLevel its exact kind.
inline constexpr std::uint8_t kFirstNearLevel = 23;
inline constexpr std::uint8_t kExactLevel = 63;

/// Values rounded to multiples of a power of two: where a transform's error ends at what float32 resolves.
struct NearRung {
  std::uint16_t bytes = 0;  ///< of the stream
  ErrorShare error;         ///< of the block's energy
};

/// What a ladder's last way to keep a block gives back.
enum class ExactKind : std::uint8_t {
  values,   ///< every bit: raw values, one value, or codes of a lattice
  ordered,  ///< every bit: floats predicted in their own order, which the survey tries where there are near rungs
  bounded,  ///< values rounded to within --max-error
};

struct PackedLadder {
  static constexpr std::size_t kMostRungs = 22;
  static constexpr std::size_t kMostNear = 12;

  std::int16_t first_step = 0;  ///< step number of rung 0
  std::uint8_t count = 0;       ///< rungs, from coarse to fine
  ExactKind exact{};
  std::uint16_t exact_bytes = 0;  ///< of the stream of the exact kind
  std::int8_t near_exponent = 0;  ///< of the coarsest near rung's quantum; each further one's is half of that
  std::uint8_t near_count = 0;
  std::array<PackedRung, kMostRungs> rungs{};
  std::array<NearRung, kMostNear> near{};  ///< from coarse to fine

  /// Step number of a rung: by whole octaves to where the first coefficient counts, then by half ones, by whole ones
  /// again, and at last, for what is nearly lossless, by two.
  std::int32_t step(std::size_t rung) const {
    const auto r = static_cast<std::int32_t>(rung);
    return first_step + (r <= 2 ? 2 * r : r <= 10 ? r + 2 : r <= 16 ? 2 * r - 8 : 4 * r - 40);
  }
};
static_assert(sizeof(PackedLadder) == 144, "ladders are spilled as they are");

}  // namespace weir
