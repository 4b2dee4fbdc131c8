// Where the chunks of a shard lie in it.
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
  static constexpr std::uint64_t kNone = ~std::uint64_t{0};  ///< of both: the chunk is not stored

  std::uint64_t offset = kNone;
  std::uint64_t bytes = kNone;

  bool stored() const { return offset != kNone || bytes != kNone; }
};

/// Bytes of the index of a shard of `chunks`.
std::uint64_t shard_index_bytes(const ZarrSharding& sharding, std::uint64_t chunks);

/// The places that `index`, of shard_index_bytes, has, the last axis's chunks beside each other. Throws Error(input),
/// beginning with `where`, where its checksum is another one and where a place is not inside the shard's `shard_bytes`
/// or reaches into the index.
std::vector<ShardPlace> parse_shard_index(const ZarrSharding& sharding, std::span<std::byte> index,
                                          std::uint64_t shard_bytes, const std::string& where);

}  // namespace weir
