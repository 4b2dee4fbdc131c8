// Deflate streams that lie in memory whole, as chunks of arrays do.
#pragma once

#include <zlib.h>

#include <cstddef>
#include <span>

namespace weir {

/// What a deflate stream is wrapped in.
enum class DeflateWrapping { zlib, gzip };

/// A decoder, kept between streams. One thread at a time.
class ChunkInflater {
 public:
  ChunkInflater();
  ~ChunkInflater();
  ChunkInflater(const ChunkInflater&) = delete;
  ChunkInflater& operator=(const ChunkInflater&) = delete;

  /// Decodes the zlib stream `stream` into all of `bytes`; both are below 4 GiB. Never writes beyond them.
  /// Throws Error(input), without a place, where the stream is damaged, ends early or holds more. Bytes
  /// after the stream's end are ignored, as HDF5 does.
  void inflate(std::span<const std::byte> stream, std::span<std::byte> bytes);

  /// The same of a stream that may hold fewer bytes than `bytes` takes: returns how many. Behind the end of a stream of
  /// gzip may be further ones, of which the bytes follow, and zeros; anything else there is damage.
  std::size_t inflate_some(std::span<const std::byte> stream, std::span<std::byte> bytes, DeflateWrapping wrapping);

 private:
  /// Decodes up to the end of one stream, from what stream_ has to what it has.
  void inflate_one(std::size_t size);

  z_stream stream_{};
};

}  // namespace weir
