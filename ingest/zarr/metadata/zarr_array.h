// The description of a Zarr array, version 2 or 3, that its metadata gives. Axes are in the array's order, slowest
// first.
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

/// A codec that compresses or checks the bytes of a chunk.
enum class ZarrPacker { zlib, gzip, zstd, blosc, crc32c };

/// A filter of version 2. It rearranges the values before they are packed, and keeps their number of bytes.
struct ZarrFilter {
  enum class Kind { shuffle, delta } kind = Kind::shuffle;
  std::size_t value_bytes = 1;          ///< for shuffle, >= 1
  ScalarType type = ScalarType::uint8;  ///< for delta: an integer, float32 or float64, as wide as the array's type
  bool big_endian = false;              ///< for delta
};

/// How the values of a chunk become the bytes that are stored.
struct ZarrCodecs {
  /// Axis i of the stored chunk is axis transpose[i] of the chunk; empty: the chunk's own order.
  std::vector<std::size_t> transpose;
  bool big_endian = false;
  std::vector<ZarrPacker> packers;       ///< in the order in which the writer applies them
  std::vector<ZarrFilter> filters = {};  ///< in the order in which the writer applies them, before the packers
};

/// Sharding: chunks lie together in one object, a shard, with an index of their places. The chunks may be shards
/// themselves.
struct ZarrSharding {
  std::vector<std::int64_t> chunk;  ///< elements of each inner chunk; divides the shard's shape
  ZarrCodecs codecs;                ///< codecs of an inner chunk that is not a shard
  bool index_big_endian = false;
  bool index_checksum = false;  ///< a crc32c follows the index
  bool index_first = false;     ///< true: the index is at the shard's start; false: at its end
};

/// How the key of a chunk is built from its position in the grid.
struct ZarrChunkKeys {
  bool prefix = false;      ///< "c" stands before the numbers, as in version 3
  char separator = '.';     ///< between all parts of the key
  std::size_t unnamed = 0;  ///< leading positions that the key omits: of axes that the array does not have

  /// Returns the key, "0.0.1" or "c/0/0/1"; "0" or "c" if there are no positions.
  std::string key(std::span<const std::int64_t> position) const;
};

struct ZarrArray {
  std::vector<std::int64_t> shape;  ///< elements, each >= 0
  std::vector<std::int64_t> chunk;  ///< elements of each stored object, each >= 1; as many axes as shape
  ScalarType type = ScalarType::float32;
  ZarrCodecs codecs;                 ///< codecs of a stored object, if there are no shards
  std::vector<ZarrSharding> shards;  ///< first of a stored object, then of the chunks in it that are shards, and so on
  ZarrChunkKeys keys;
  std::optional<std::vector<std::byte>> fill;  ///< one value, in the byte order of values(); nullopt: it is null
  std::string fill_text;                       ///< as the metadata writes it
  /// The fill value, if it stands for missing data: xarray writes _FillValue this way in version 2.
  std::optional<StoredValue> missing_fill = {};
  std::vector<std::string> axis_names;  ///< one text for each axis; empty if the axis has no name
  nlohmann::json attributes;            ///< the user attributes

  /// The shape of the elements that are decoded together, and their codecs: those of an inner chunk if there are
  /// shards.
  const std::vector<std::int64_t>& unit() const { return shards.empty() ? chunk : shards.back().chunk; }
  const ZarrCodecs& values() const { return shards.empty() ? codecs : shards.back().codecs; }

  /// Returns the layout as text: "chunked 64 x 64 x 64 in shards of 256 x 256 x 256, blosc, crc32c".
  std::string layout_text() const;
};

/// Returns the name of the filter, for example "shuffle".
const char* filter_name(ZarrFilter::Kind kind);
/// Returns the name of the packer, for example "zstd".
const char* packer_name(ZarrPacker packer);

}  // namespace weir
