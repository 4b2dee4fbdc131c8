// HDF5's deflate filter, undone: a zlib stream into memory of known size.
#pragma once

#include <zlib.h>

#include <cstddef>
#include <span>

namespace weir {

/// A zlib decoder for streams that lie in memory whole, kept between them. One thread at a time.
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

 private:
  z_stream stream_{};
};

}  // namespace weir
