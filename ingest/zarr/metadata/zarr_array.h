// An array of Zarr, version 2 or 3, as its metadata describes it. Axes in the array's order, slowest first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "format/base/scalar_type.h"
#include "ingest/source/stored_value.h"

namespace weir {

/// What packs or checks the bytes of a chunk.
enum class ZarrPacker { zlib, gzip, zstd, blosc, crc32c };

/// A filter of version 2, which rearranges values before they are packed, and keeps their number of bytes.
struct ZarrFilter {
  enum class Kind { shuffle, delta } kind = Kind::shuffle;
  std::size_t value_bytes = 1;          ///< of shuffle, >= 1
  ScalarType type = ScalarType::uint8;  ///< of delta: an integer, float32 or float64, as wide as the array's
  bool big_endian = false;              ///< of delta
};

/// How the values of a chunk become the bytes that are stored.
struct ZarrCodecs {
  /// Axis i of what is stored is axis transpose[i] of the chunk; empty: the chunk's own order.
  std::vector<std::size_t> transpose;
  bool big_endian = false;
  std::vector<ZarrPacker> packers;       ///< in the order of writing
  std::vector<ZarrFilter> filters = {};  ///< in the order of writing, before the packers
};

/// Chunks that lie together in one object, a shard, with an index of their places. They may be shards themselves.
struct ZarrSharding {
  std::vector<std::int64_t> chunk;  ///< elements of each inner chunk; divides the shard's
  ZarrCodecs codecs;                ///< of an inner chunk that is no shard
  bool index_big_endian = false;
  bool index_checksum = false;  ///< a crc32c behind the index
  bool index_first = false;     ///< else at the shard's end
};

/// How the key of a chunk is made of its position in the grid.
struct ZarrChunkKeys {
  bool prefix = false;      ///< "c" stands before the numbers, as in version 3
  char separator = '.';     ///< between all parts
  std::size_t unnamed = 0;  ///< positions in front that are not in the key, of axes that the array does not have

  /// "0.0.1" or "c/0/0/1"; "0" or "c" where there are no positions.
  std::string key(std::span<const std::int64_t> position) const;
};

struct ZarrArray {
  std::vector<std::int64_t> shape;  ///< elements, each >= 0
  std::vector<std::int64_t> chunk;  ///< elements of each stored object, each >= 1; as many axes as shape
  ScalarType type = ScalarType::float32;
  ZarrCodecs codecs;                 ///< of a stored object without shards
  std::vector<ZarrSharding> shards;  ///< of a stored object, of the chunks in it that are shards, and so on
  ZarrChunkKeys keys;
  std::optional<std::vector<std::byte>> fill;  ///< one value, in the byte order of values(); none: it is null
  std::string fill_text;                       ///< as the metadata writes it
  /// The fill value where it stands for no data: xarray writes _FillValue so in version 2.
  std::optional<StoredValue> missing_fill = {};
  std::vector<std::string> axis_names;  ///< as many as axes; empty texts where there are none
  nlohmann::json attributes;            ///< of the user

  /// The elements that are decoded together, and how: of an inner chunk where there are shards.
  const std::vector<std::int64_t>& unit() const { return shards.empty() ? chunk : shards.back().chunk; }
  const ZarrCodecs& values() const { return shards.empty() ? codecs : shards.back().codecs; }

  /// "chunked 64 x 64 x 64 in shards of 256 x 256 x 256, blosc, crc32c".
  std::string layout_text() const;
};

/// "shuffle".
const char* filter_name(ZarrFilter::Kind kind);
/// "zstd".
const char* packer_name(ZarrPacker packer);

}  // namespace weir
