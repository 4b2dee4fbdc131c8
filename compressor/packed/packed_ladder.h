// The ladder of a block that may be packed: for some steps of the quantiser, the bytes of the block's stream and the
// error that it leaves, so that selection can choose among them. The survey spills one fixed-size record per block.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "format/packed/block_steps.h"
#include "format/packed/near_rungs.h"

namespace weir {

/// A share of a block's energy (the squared error of its mean): (1 + m / 1024) * 2^-e, within a part in 2,000.
class ErrorShare {
 public:
  ErrorShare() = default;
  /// `share` is from 0 to 1.
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
  static constexpr std::uint64_t kLargestExponent = 62;
  static constexpr std::uint16_t kNone = 0xFFFF;
  std::uint16_t code_ = kNone;  // e << 10 | m
};

/// The bytes that a way to keep a block takes, and the error that it leaves.
struct RungPoint {
  double bytes = 0;
  double share = 0;  ///< of the block's energy
};

struct PackedRung {
  std::uint16_t bits = 0;  ///< of the stream without its mean's code; 0: not built, or no better than exact
  ErrorShare error;        ///< of the block's energy
};

/// The most bits of a mean's code if every voxel must be within an error. The product of code and quantum then rounds
/// to within a 16th of a quantum.
inline constexpr unsigned kMostBoundedMeanBits = 20;

/// Levels of a block in LeafChoices: 0 no stream, 1 to 22 the rungs of its ladder, from kFirstNearLevel on its near
/// rungs (nearly lossless), kExactLevel its exact kind.
inline constexpr std::uint8_t kFirstNearLevel = 23;
inline constexpr std::uint8_t kExactLevel = 63;

/// A rung with values rounded to multiples of a power of two. It is for errors so small that float32's resolution
/// limits the transform.
struct NearRung {
  std::uint16_t bytes = 0;  ///< of the stream; 0: not built, or no better than exact
  ErrorShare error;         ///< of the block's energy
};

/// The precision of a ladder's last way to keep a block.
enum class ExactKind : std::uint8_t {
  values,   ///< every bit: raw values, one value, or codes of a lattice
  ordered,  ///< every bit: floats predicted in their own order, tried in the survey if there are near rungs
  bounded,  ///< values rounded to within --max-error
};

struct PackedLadder {
  static constexpr std::size_t kMostRungs = kLadderRungs;
  static constexpr std::size_t kMeanRungs = kLadderMeanRungs;
  static constexpr std::size_t kMostNear = kNearRungs;

  std::int16_t first_step = 0;  ///< step number of rung 0
  std::uint8_t count = 0;       ///< rungs, from coarse to fine, up to the last one that is built
  ExactKind exact{};
  std::uint16_t exact_bytes = 0;  ///< of the stream of the exact kind
  std::int8_t near_exponent = 0;  ///< of the coarsest near rung's quantum; each further quantum is half the last
  std::uint8_t near_count = 0;    ///< near rungs up to the last one that is built
  std::array<PackedRung, kMostRungs> rungs{};
  std::array<NearRung, kMostNear> near{};  ///< from coarse to fine

  /// Return the point of a rung (without its mean's code) or of a near rung; nullopt if it is not built.
  std::optional<RungPoint> point(std::size_t rung) const {
    if (rungs[rung].bits == 0) return std::nullopt;
    return RungPoint{rungs[rung].bits / 8.0, rungs[rung].error.value()};
  }
  std::optional<RungPoint> near_point(std::size_t rung) const {
    if (near[rung].bytes == 0) return std::nullopt;
    return RungPoint{static_cast<double>(near[rung].bytes), near[rung].error.value()};
  }

  /// Returns the step number of a rung.
  std::int32_t step(std::size_t rung) const { return first_step + kRungOffsets[rung]; }
};
static_assert(sizeof(PackedLadder) == 144, "ladders are spilled as they are");
static_assert(std::size_t{kFirstNearLevel} == PackedLadder::kMostRungs + 1, "levels of rungs end where others begin");
static_assert(std::size_t{kFirstNearLevel} + PackedLadder::kMostNear <= kExactLevel, "each near rung has a level");

}  // namespace weir
