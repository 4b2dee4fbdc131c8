#include "ingest/zarr/codecs/codec_chain.h"

#include <algorithm>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/zarr/codecs/crc32c.h"
#include "ingest/zarr/codecs/filters.h"
#include "ingest/zarr/codecs/library_codecs.h"
#include "ingest/zarr/codecs/transpose.h"

namespace weir {
namespace {

/// Returns the most bytes that `bytes` bytes can take after packing: a compressor's output for noise, and its
/// headers.
std::size_t most_packed(ZarrPacker packer, std::size_t bytes) {
  constexpr std::size_t kHeaders = 1024;  // a gzip header may hold a file name
  return packer == ZarrPacker::crc32c ? bytes + kCrc32cBytes : bytes + bytes / 256 + kHeaders;
}

/// Returns the most bytes that a chunk can take before the packer at `i`.
std::size_t most_before(const ZarrCodecs& codecs, std::size_t chunk_bytes, std::size_t i) {
  std::size_t bytes = chunk_bytes;
  for (std::size_t k = 0; k < i; ++k) bytes = most_packed(codecs.packers[k], bytes);
  return bytes;
}

std::size_t unpack(ZarrPacker packer, std::span<const std::byte> packed, std::span<std::byte> bytes,
                   ChunkInflater& inflater) {
  switch (packer) {
    case ZarrPacker::zlib:
      return inflater.inflate_some(packed, bytes, DeflateWrapping::zlib);
    case ZarrPacker::gzip:
      return inflater.inflate_some(packed, bytes, DeflateWrapping::gzip);
    case ZarrPacker::zstd:
      return unpack_zstd(packed, bytes);
    default:
      return unpack_blosc(packed, bytes);
  }
}

}  // namespace

std::size_t ChunkShape::bytes() const {
  std::size_t bytes = value_bytes;
  for (const std::int64_t e : extent) bytes *= static_cast<std::size_t>(e);
  return bytes;
}

std::size_t most_stored_bytes(const ZarrCodecs& codecs, std::size_t chunk_bytes) {
  return most_before(codecs, chunk_bytes, codecs.packers.size());
}

ScratchSize scratch_size(const ZarrCodecs& codecs, std::size_t chunk_bytes) {
  ScratchSize size{chunk_bytes, most_stored_bytes(codecs, chunk_bytes),
                   !codecs.transpose.empty() || !codecs.filters.empty(), 0};
  for (const ZarrPacker packer : codecs.packers) {
    size.two = size.two || packer != ZarrPacker::crc32c;
    if (packer == ZarrPacker::zstd) size.codec_bytes = std::max(size.codec_bytes, kZstdBytes);
    if (packer != ZarrPacker::blosc) continue;
    size.codec_bytes = std::max(size.codec_bytes, kBloscCopies * std::min(size.buffer_bytes, kMostBloscBlock));
  }
  return size;
}

std::span<const std::byte> decode_chunk(const ZarrCodecs& codecs, const ChunkShape& shape, std::size_t stored,
                                        ChunkScratch& scratch) {
  const std::size_t chunk_bytes = shape.bytes();
  std::span<std::byte> buffer = scratch.buffer.bytes();
  std::span<std::byte> other = scratch.other.bytes();
  std::span<std::byte> bytes = buffer.first(stored);
  for (std::size_t i = codecs.packers.size(); i-- > 0;) {
    if (codecs.packers[i] == ZarrPacker::crc32c) {
      bytes = check_crc32c(bytes);
      continue;
    }
    const std::span<std::byte> room = other.first(most_before(codecs, chunk_bytes, i));
    bytes = room.first(unpack(codecs.packers[i], bytes, room, scratch.inflater));
    std::swap(buffer, other);
  }
  if (bytes.size() != chunk_bytes) {
    throw Error(ErrorKind::input, cat("holds ", bytes.size(), " bytes, not ", chunk_bytes));
  }
  for (std::size_t i = codecs.filters.size(); i-- > 0;) {
    const std::span<std::byte> undone = undo_filter(codecs.filters[i], bytes, other.first(chunk_bytes));
    if (undone.data() != bytes.data()) std::swap(buffer, other);
    bytes = undone;
  }
  if (codecs.transpose.empty()) return bytes;
  undo_transpose(bytes, shape.extent, codecs.transpose, shape.value_bytes, other.first(chunk_bytes));
  return other.first(chunk_bytes);
}

}  // namespace weir
