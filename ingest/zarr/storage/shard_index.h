// The index of a shard: the places of its chunks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ingest/zarr/metadata/zarr_array.h"

namespace weir {

/// A chunk's bytes in its shard.
struct ShardPlace {
  static constexpr std::uint64_t kNone = ~std::uint64_t{0};  ///< as offset and as bytes: the chunk is not stored

  std::uint64_t offset = kNone;
  std::uint64_t bytes = kNone;

  bool stored() const { return offset != kNone || bytes != kNone; }
};

/// Returns the bytes of the index of a shard with `chunks` chunks.
std::uint64_t shard_index_bytes(const ZarrSharding& sharding, std::uint64_t chunks);

/// Returns the places in `index`, which has shard_index_bytes(), the last axis fastest. Throws Error(input),
/// beginning with `where`, if the checksum does not match, or if a place is not inside the shard's `shard_bytes` or
/// overlaps the index.
std::vector<ShardPlace> parse_shard_index(const ZarrSharding& sharding, std::span<std::byte> index,
                                          std::uint64_t shard_bytes, const std::string& where);

}  // namespace weir
