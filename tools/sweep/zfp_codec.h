// ZFP in fixed-rate mode (P. Lindstrom, "Fixed-Rate Compressed Floating-Point Arrays", IEEE TVCG 2014), by libzfp: the
// codec that weir's methods are compared with. Each block of 4^3 voxels is coded separately into the same number of
// bits, so that parts of a volume decode to the same values as the whole volume.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "format/base/index.h"

namespace weir {

inline constexpr std::int64_t kZfpBlockDim = 4;  ///< voxels; blocks at the upper faces are padded
inline constexpr unsigned kLeastZfpBits = 9;     ///< bits per block: a zero flag and the exponent
inline constexpr unsigned kMostZfpBits = 16658;  ///< bits per block, the library's limit

/// Returns whether this build has zfp (WEIR_ZFP); without it, all other calls throw Error(usage).
bool has_zfp();

/// Returns the bytes of one stream, without a header, for a volume of `extent` voxels: the bits of all blocks, rounded
/// up to a whole word of the library.
std::uint64_t zfp_stream_bytes(const Index3& extent, unsigned block_bits);

/// Returns the largest number of bits per block, up to kMostZfpBits, with which the volume's stream takes at most
/// `bytes`; nullopt if that is below kLeastZfpBits.
std::optional<unsigned> zfp_block_bits(const Index3& extent, std::uint64_t bytes);

/// A box inside an array of floats, x fastest.
struct ZfpField {
  const float* values = nullptr;  ///< first voxel of the box
  Index3 extent;                  ///< voxels of the box
  Index3 array;                   ///< extent of the array that contains the box
};

/// The coder of one thread, with its buffers.
class ZfpCodec {
 public:
  explicit ZfpCodec(unsigned block_bits) : block_bits_(block_bits) {}

  /// Returns the stream, zfp_stream_bytes(field.extent) bytes long, valid until the next call. All values must be
  /// finite, because ZFP has no code for others. Throws Error(internal) if the library fails.
  std::span<const std::byte> compress(const ZfpField& field);

  /// Returns the buffer for the stream of a box of `extent` voxels, to be filled before decompress().
  std::span<std::byte> stream_buffer(const Index3& extent);
  /// Returns the values of the box, x fastest, valid until the next call. Throws as compress.
  std::span<const float> decompress(const Index3& extent);

 private:
  unsigned block_bits_;
  std::vector<std::uint64_t> words_;  ///< the stream, aligned for words of any size
  std::vector<float> values_;
};

}  // namespace weir
