// The objects that the chunks of a volume lie in, as they are before it is read.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "format/base/index.h"
#include "ingest/zarr/metadata/zarr_array.h"
#include "ingest/zarr/storage/chunk_geometry.h"
#include "ingest/zarr/store/zarr_store.h"

namespace weir {

/// What may be chunks of one array: their store, the array's key and how its chunks' keys are made.
struct ChunkObjects {
  ZarrStore& store;
  std::string array_key;
  ZarrChunkKeys keys;

  std::string key_of(const std::vector<std::int64_t>& position) const {
    return joined_key(array_key, keys.key(position));
  }
};

struct ObjectScan {
  std::vector<bool> stored;  ///< of ChunkGeometry::objects, x fastest
  std::uint64_t bytes = 0;
  std::int64_t mtime_ns = 0;  ///< the newest
  std::int64_t ctime_ns = 0;  ///< the newest: what has a newer one was changed since
  std::string digest;         ///< of all their states

  bool has(const ChunkGeometry& geometry, const Index3& object) const {
    return stored[static_cast<std::size_t>(linear_index(object, geometry.objects()))];
  }
};

/// Looks at all objects that `geometry` touches. Throws Error(usage) where they are more than a sixteenth of `memory`
/// has bits for, Error(input) where something else lies in the place of one, Error(io) where one cannot be looked at,
/// Error(interrupted) where `cancel` is set.
ObjectScan scan_objects(const ChunkObjects& objects, const ChunkGeometry& geometry, std::uint64_t memory,
                        const std::atomic<bool>* cancel);

/// Of objects none of which is stored, the key of one that is stored with the other separator between its positions;
/// empty where the first few thousand have none, or some are stored.
std::string key_by_other_separator(const ChunkObjects& objects, const ChunkGeometry& geometry, const ObjectScan& scan);

}  // namespace weir
