#include "tools/sweep/zfp_codec.h"

#include <zfp.h>

#include <algorithm>
#include <memory>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

// The library's streams consist of whole words, of 8 to 64 bits depending on how it was built.
std::uint64_t word_bytes() { return ::stream_word_bits / 8; }

static_assert(kMostZfpBits == ZFP_MAX_BITS);

std::uint64_t blocks_of(const Index3& extent) {
  const auto along = [](std::int64_t voxels) {
    return static_cast<std::uint64_t>((voxels + kZfpBlockDim - 1) / kZfpBlockDim);
  };
  return along(extent.x) * along(extent.y) * along(extent.z);
}

/// The library's three objects for one box. Stream and field refer to the caller's memory.
class Coder {
 public:
  Coder(unsigned block_bits, std::span<std::byte> stream, const ZfpField& field)
      : bits_(::stream_open(stream.data(), stream.size()), &::stream_close),
        zfp_(::zfp_stream_open(bits_.get()), &::zfp_stream_close),
        // The C interface takes a non-const pointer, but compressing only reads from it.
        field_(
            ::zfp_field_3d(const_cast<float*>(field.values), zfp_type_float, static_cast<std::size_t>(field.extent.x),
                           static_cast<std::size_t>(field.extent.y), static_cast<std::size_t>(field.extent.z)),
            &::zfp_field_free) {
    if (!bits_ || !zfp_ || !field_) throw std::bad_alloc();
    ::zfp_field_set_stride_3d(field_.get(), 1, field.array.x, field.array.x * field.array.y);
    constexpr double kBlockVoxels = kZfpBlockDim * kZfpBlockDim * kZfpBlockDim;
    ::zfp_stream_set_rate(zfp_.get(), block_bits / kBlockVoxels, zfp_type_float, 3, zfp_false);
    if (zfp_->maxbits != block_bits) {
      throw Error(ErrorKind::internal, cat("libzfp takes ", zfp_->maxbits, " bits a block, ", block_bits, " asked"));
    }
  }

  std::size_t compress() { return ::zfp_compress(zfp_.get(), field_.get()); }
  std::size_t decompress() { return ::zfp_decompress(zfp_.get(), field_.get()); }

 private:
  std::unique_ptr<bitstream, decltype(&::stream_close)> bits_;
  std::unique_ptr<zfp_stream, decltype(&::zfp_stream_close)> zfp_;
  std::unique_ptr<zfp_field, decltype(&::zfp_field_free)> field_;
};

}  // namespace

bool has_zfp() { return true; }

std::uint64_t zfp_stream_bytes(const Index3& extent, unsigned block_bits) {
  const std::uint64_t word_bits = 8 * word_bytes();
  return (blocks_of(extent) * block_bits + word_bits - 1) / word_bits * word_bytes();
}

std::optional<unsigned> zfp_block_bits(const Index3& extent, std::uint64_t bytes) {
  const std::uint64_t whole = bytes - bytes % word_bytes();
  const std::uint64_t blocks = blocks_of(extent);
  if (whole / blocks > kMostZfpBits / 8) return kMostZfpBits;  // before a product overflows
  const std::uint64_t bits = whole / blocks * 8 + whole % blocks * 8 / blocks;
  if (bits < kLeastZfpBits) return std::nullopt;
  return static_cast<unsigned>(std::min<std::uint64_t>(bits, kMostZfpBits));
}

std::span<std::byte> ZfpCodec::stream_buffer(const Index3& extent) {
  const std::uint64_t bytes = zfp_stream_bytes(extent, block_bits_);
  words_.resize((bytes + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t));
  return std::as_writable_bytes(std::span(words_)).first(bytes);
}

std::span<const std::byte> ZfpCodec::compress(const ZfpField& field) {
  const std::span<std::byte> stream = stream_buffer(field.extent);
  const std::size_t bytes = Coder(block_bits_, stream, field).compress();
  if (bytes != stream.size()) {
    throw Error(ErrorKind::internal, cat("libzfp wrote ", bytes, " bytes instead of ", stream.size()));
  }
  return stream;
}

std::span<const float> ZfpCodec::decompress(const Index3& extent) {
  values_.resize(static_cast<std::size_t>(volume(extent)));
  const std::span<std::byte> stream = stream_buffer(extent);
  const std::size_t bytes = Coder(block_bits_, stream, {values_.data(), extent, extent}).decompress();
  if (bytes != stream.size()) {
    throw Error(ErrorKind::internal, cat("libzfp read ", bytes, " bytes instead of ", stream.size()));
  }
  return values_;
}

}  // namespace weir
