#include "ingest/zarr/codecs/library_codecs.h"

#include <blosc.h>
#include <zstd.h>

#include <algorithm>
#include <climits>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {

bool has_library_codecs() { return true; }

std::size_t unpack_zstd(std::span<const std::byte> packed, std::span<std::byte> bytes) {
  const std::size_t size = ZSTD_decompress(bytes.data(), bytes.size(), packed.data(), packed.size());
  if (ZSTD_isError(size) == 0) return size;
  throw Error(ErrorKind::input,
              cat("its zstd frame cannot be decoded into ", bytes.size(), " bytes (", ZSTD_getErrorName(size), ")"));
}

std::size_t unpack_blosc(std::span<const std::byte> packed, std::span<std::byte> bytes) {
  std::size_t size = 0;
  if (packed.size() < BLOSC_MIN_HEADER_LENGTH || blosc_cbuffer_validate(packed.data(), packed.size(), &size) != 0) {
    throw Error(ErrorKind::input, cat("its ", packed.size(), " bytes are no whole blosc buffer"));
  }
  if (size > bytes.size()) {
    throw Error(ErrorKind::input, cat("its blosc buffer holds ", size, " bytes, more than ", bytes.size()));
  }
  std::size_t all = 0;
  std::size_t stored = 0;
  std::size_t block = 0;
  blosc_cbuffer_sizes(packed.data(), &all, &stored, &block);
  if (block > kMostBloscBlock && block > all) {  // blosc never makes a block larger than its buffer
    throw Error(ErrorKind::input, cat("its blosc buffer of ", size, " bytes is damaged (its blocks are larger)"));
  }
  if (block > kMostBloscBlock) {
    throw Error(ErrorKind::input, cat("its blosc blocks have ", block, " bytes, more than the ", kMostBloscBlock,
                                      " that are decoded; write it with blocksize 0"));
  }
  const std::size_t room = std::min<std::size_t>(bytes.size(), INT_MAX);
  const int got = blosc_decompress_ctx(packed.data(), bytes.data(), room, 1);
  if (got >= 0 && static_cast<std::size_t>(got) == size) return size;
  throw Error(ErrorKind::input, cat("its blosc buffer of ", size, " bytes is damaged (", got, ")"));
}

}  // namespace weir
