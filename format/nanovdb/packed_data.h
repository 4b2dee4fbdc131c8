// The packed data of a grid in memory (mapped or not). The constructor checks and copies header and tables; look-ups
// check directories and streams. So no call reads outside the bytes, whatever they are. All calls are const and
// thread-safe. See FORMAT.md, "Packed data".
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "format/base/index.h"
#include "format/nanovdb/nvdb_bytes.h"
#include "format/nanovdb/packed_chunk.h"
#include "format/nanovdb/packed_header.h"

namespace weir {

/// The stream of a block.
struct PackedStream {
  const std::byte* data = nullptr;  ///< null: the block has none
  std::uint32_t bytes = 0;
  MeanRange means;  ///< of the block's region
};

inline PackedKind packed_kind(const PackedStream& stream) {
  return static_cast<PackedKind>(stream.data[0] & std::byte{3});
}

class PackedData {
 public:
  /// `bytes` begin at `file_offset` of the file `path`, which is for messages only, and must stay valid and unchanged;
  /// `bbox` is the grid's index box. Throws Error(input) that names offset and value.
  PackedData(std::span<const std::byte> bytes, std::uint64_t file_offset, const std::string& path, const Box& bbox);
  PackedData(const PackedData&) = delete;
  PackedData& operator=(const PackedData&) = delete;

  const PackedHeader& header() const { return header_; }
  /// Regions of 128^3 voxels over the index box.
  const NodeLattice& regions() const { return header_.regions; }
  /// Returns the entry of the region at lattice position `position`.
  PackedRegion region(const Index3& position) const { return packed_region(view(), header_, position); }
  /// Returns the whole packed data.
  std::span<const std::byte> bytes() const { return bytes_; }
  std::uint64_t file_offset() const { return file_offset_; }  ///< offset of its first byte
  const std::string& path() const { return path_; }

  /// Returns the stream of the block at `position` (see packed_position()) of a region; empty if it has none. A look-up
  /// reads one entry of the directory. Throws Error(input) if the directory is damaged.
  PackedStream stream(const PackedRegion& region, unsigned position) const;
  /// Calls visit(position, stream) for all 4096 blocks of a region that has a chunk. Throws as stream().
  void for_each_stream(const PackedRegion& region,
                       const std::function<void(unsigned, const PackedStream&)>& visit) const;

  /// Decodes a stream into 512 values, index x<<6 | y<<3 | z (z fastest). Throws Error(input) if the stream is damaged.
  void decode(const PackedStream& stream, std::span<float, 512> values) const;

 private:
  NvdbBytes view() const { return {bytes_, file_offset_, path_}; }
  // Returns the bytes of a chunk, or of a part of it.
  NvdbBytes part(std::uint64_t offset, std::uint64_t bytes) const {
    return {bytes_.subspan(offset, bytes), file_offset_ + offset, path_};
  }

  std::span<const std::byte> bytes_;
  std::uint64_t file_offset_;
  std::string path_;
  PackedHeader header_;
  BlockConstants constants_;
};

/// Decodes `stream`, which begins at `file_offset` of the file `path`. Throws Error(input) if the stream is damaged.
void decode_packed_stream(const BlockConstants& constants, const PackedStream& stream, std::span<float, 512> values,
                          std::uint64_t file_offset, const std::string& path);

}  // namespace weir
