// Scans the stored objects of a volume's chunks before the volume is read.
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

/// The objects that may hold chunks of one array: their store, the array's key, and the form of the chunk keys.
struct ChunkObjects {
  ZarrStore& store;
  std::string array_key;
  ZarrChunkKeys keys;

  std::string key_of(const std::vector<std::int64_t>& position) const {
    return joined_key(array_key, keys.key(position));
  }
};

struct ObjectScan {
  std::vector<bool> stored;  ///< for each of ChunkGeometry::objects, x fastest
  std::uint64_t bytes = 0;
  std::int64_t mtime_ns = 0;  ///< the newest
  std::int64_t ctime_ns = 0;  ///< the newest: an object with a newer one was changed after the scan
  std::string digest;         ///< of the states of all objects

  bool has(const ChunkGeometry& geometry, const Index3& object) const {
    return stored[static_cast<std::size_t>(linear_index(object, geometry.objects()))];
  }
};

/// Looks at all objects that `geometry` touches. Keeps one bit for each. Throws Error(usage) if a sixteenth of
/// `memory` does not hold these bits, Error(input) if something that is not an object lies in the place of one,
/// Error(io) if an object cannot be looked at, and Error(interrupted) if `cancel` is set.
ObjectScan scan_objects(const ChunkObjects& objects, const ChunkGeometry& geometry, std::uint64_t memory,
                        const std::atomic<bool>* cancel);

/// If no object is stored, returns the key of an object that is stored with the other separator between its
/// positions. Returns an empty text if some objects are stored, or if the first few thousand keys find none.
std::string key_by_other_separator(const ChunkObjects& objects, const ChunkGeometry& geometry, const ObjectScan& scan);

}  // namespace weir
