// ZFP in its fixed-rate mode (P. Lindstrom, "Fixed-Rate Compressed Floating-Point
// Arrays", IEEE TVCG 2014), by libzfp: the codec that other compressors are compared with. Blocks of 4^3 voxels are
// coded one by one into the same number of bits, so that the parts of a volume decode to what the volume in one piece
// decodes to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "format/base/index.h"

namespace weir {

inline constexpr std::int64_t kZfpBlockDim = 4;  ///< voxels; blocks at the upper faces are padded
inline constexpr unsigned kLeastZfpBits = 9;     ///< a block: whether it is zero, and its exponent
inline constexpr unsigned kMostZfpBits = 16658;  ///< a block, the library's limit

/// Whether this build has it (WEIR_ZFP); all else throws Error(usage) where it has not.
bool has_zfp();

/// Bytes of a volume of `extent` voxels in one stream without a header: the blocks' bits, up to a whole word of
/// the library's.
std::uint64_t zfp_stream_bytes(const Index3& extent, unsigned block_bits);

/// The most bits a block, up to kMostZfpBits, with which the volume's stream takes at most `bytes`; none where
/// that is fewer than kLeastZfpBits.
std::optional<unsigned> zfp_block_bits(const Index3& extent, std::uint64_t bytes);

/// A box inside an array of floats, x fastest.
struct ZfpField {
  const float* values = nullptr;  ///< first voxel of the box
  Index3 extent;                  ///< voxels of the box
  Index3 array;                   ///< extent of the array it lies in
};

/// One thread's coder and its buffers.
class ZfpCodec {
 public:
  explicit ZfpCodec(unsigned block_bits) : block_bits_(block_bits) {}

  /// The stream, zfp_stream_bytes(field.extent) long, valid until the next call. All values are finite: others
  /// have no code. Throws Error(internal) where the library fails.
  std::span<const std::byte> compress(const ZfpField& field);

  /// Where decompress finds the stream of a box of `extent` voxels; to be filled before.
  std::span<std::byte> stream_buffer(const Index3& extent);
  /// The box's values, x fastest, valid until the next call. Throws as compress.
  std::span<const float> decompress(const Index3& extent);

 private:
  unsigned block_bits_;
  std::vector<std::uint64_t> words_;  ///< the stream, aligned for words of any size
  std::vector<float> values_;
};

}  // namespace weir
