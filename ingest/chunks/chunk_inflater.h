// Decodes deflate streams that lie in memory as a whole, as chunks of arrays do.
#pragma once

#include <zlib.h>

#include <cstddef>
#include <span>

namespace weir {

/// The wrapper around a deflate stream.
enum class DeflateWrapping { zlib, gzip };

/// A decoder that is kept between streams. One thread at a time.
class ChunkInflater {
 public:
  ChunkInflater();
  ~ChunkInflater();
  ChunkInflater(const ChunkInflater&) = delete;
  ChunkInflater& operator=(const ChunkInflater&) = delete;

  /// Decodes the zlib stream `stream` into all of `bytes`; both are below 4 GiB. Never writes beyond `bytes`. Throws
  /// Error(input), without a place, if the stream is damaged, ends early or holds more. Bytes after the stream's end
  /// are ignored, as HDF5 does.
  void inflate(std::span<const std::byte> stream, std::span<std::byte> bytes);

  /// Decodes a stream that may hold fewer bytes than `bytes` takes, and returns how many it holds. After the end of a
  /// gzip stream, further streams may follow, which are decoded behind it, and zeros. Anything else there is damage.
  std::size_t inflate_some(std::span<const std::byte> stream, std::span<std::byte> bytes, DeflateWrapping wrapping);

 private:
  /// Decodes up to the end of one stream. stream_ has the input and the output.
  void inflate_one(std::size_t size);

  z_stream stream_{};
};

}  // namespace weir
