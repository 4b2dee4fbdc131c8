// The data besides its stream that the decoder of a packed block needs (FORMAT.md, "Packed data"): the file's constants
// and the range of means of the block's region. This header includes no standard library, because kernels include it.
#pragma once

#include <cstdint>

namespace weir {

/// Contexts of the entropy coder: 4 bands of 24 levels for transformed blocks, 24 levels for residuals.
inline constexpr unsigned kPackedLevels = 24;
inline constexpr unsigned kPackedBands = 4;
inline constexpr unsigned kPackedTables = kPackedLevels * (kPackedBands + 1);
inline constexpr unsigned kPackedSymbols = 16;
/// The frequencies of a table add up to 2^kFrequencyBits.
inline constexpr unsigned kFrequencyBits = 12;
inline constexpr std::uint32_t kFrequencyTotal = 1U << kFrequencyBits;

/// The most bits of a code on a lattice.
inline constexpr std::uint32_t kMostLatticeBits = 24;

/// How a stream codes its block; the lowest two bits of its first byte hold it.
enum class PackedKind : std::uint8_t { mean = 0, transform = 1, lattice = 2, raw = 3 };
inline constexpr unsigned kPackedKinds = 4;

struct BlockConstants {
  /// Decoded values are clamped to [minimum, maximum], except raw floats and floats in their own order.
  float minimum = 0;
  float maximum = 0;
  std::int32_t coarsest = 0;  ///< step number of a step field of 0
  float lattice_minimum = 0;
  float lattice_quantum = 0;       ///< 0: the file has no lattice
  std::uint32_t lattice_bits = 0;  ///< bits of a code on the file's lattice
  float below_one = 0;             ///< a coefficient of magnitude 1 decodes to (1 - below_one) steps
  float below_more = 0;            ///< a coefficient of magnitude m >= 2 decodes to (m - below_more) steps
  /// kPackedTables x kPackedSymbols cumulative frequencies, each table with a total of kFrequencyTotal.
  const std::uint16_t* tables = nullptr;
};

/// The range of the blocks' means in a region of 128^3 voxels; finite, low <= high.
struct MeanRange {
  float low = 0;
  float high = 0;
};

}  // namespace weir
