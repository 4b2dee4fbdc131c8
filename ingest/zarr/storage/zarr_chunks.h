// The chunks of a volume in a Zarr array, fetched and decoded one by one.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "ingest/chunks/chunk_boxes.h"
#include "ingest/chunks/chunk_scratch.h"
#include "ingest/zarr/metadata/zarr_array.h"
#include "ingest/zarr/storage/chunk_geometry.h"
#include "ingest/zarr/storage/object_scan.h"
#include "ingest/zarr/storage/open_shards.h"
#include "ingest/zarr/store/zarr_store.h"

namespace weir {

/// Chunks that are not stored.
struct UnstoredChunks {
  std::uint64_t count = 0;
  std::uint64_t all = 0;  ///< chunks that were asked for
  std::string first;      ///< "run.zarr/rho/c/0/0/1: chunk at 0, 0, 64"; empty where there is none
};

/// Thread-safe.
class ZarrChunks final : public StoredChunks {
 public:
  /// `objects.store` outlives it. Throws what scan_objects and OpenShards throw.
  ZarrChunks(ChunkObjects objects, ZarrArray array, ChunkGeometry geometry, std::uint64_t memory,
             const std::atomic<bool>* cancel);

  const ObjectScan& scan() const { return scan_; }
  const ChunkGeometry& geometry() const { return geometry_; }
  std::string key_by_other_separator() const { return weir::key_by_other_separator(objects_, geometry_, scan_); }
  /// Counts those that `voxels` touch: reads the index of every shard with such. Throws what decode throws of an index.
  UnstoredChunks count_unstored(const Box& voxels);
  std::uint64_t working_bytes() const;
  std::uint64_t bytes_read() const { return bytes_read_; }

  /// Throws Error(input), naming the object and the chunk's first element, where it is larger than it can be, damaged,
  /// not there any more or was changed since the scan.
  std::span<const std::byte> decode(const Index3& chunk, ChunkScratch& scratch) override;
  /// The same with what lies before the volume's first voxel in a chunk that is several thick along other axes.
  std::span<const std::byte> decode_whole(const Index3& chunk, ChunkScratch& scratch);

 private:
  /// Throws where it was changed or is not there any more.
  std::unique_ptr<ZarrObject> open_unchanged(const std::string& key) const;
  /// The shard that is the object at `key`.
  std::shared_ptr<const OpenShard> outer_shard(const std::string& key);
  /// The shard in that object that lies at path.back() in `around`, which lies at the rest of `path`; nullptr where it
  /// is not stored.
  std::shared_ptr<const OpenShard> inner_shard(const OpenShard& outer, const OpenShard& around,
                                               std::span<const std::size_t> path);
  void count_unstored_in(const OpenShard& outer, const OpenShard& around, const Box& chunks,
                         std::vector<std::size_t>& path, UnstoredChunks& unstored);
  /// Those in `chunks`, an object's.
  void add_unstored(const Box& chunks, UnstoredChunks& unstored) const;
  /// The bytes of the chunk to the front of `into`; nullopt where the shard has none.
  std::optional<std::size_t> fetch(const ChunkPlace& place, std::span<std::byte> into);
  /// Its first element, of the axes that the array has.
  std::string corner_text(const ChunkPlace& place) const;
  Error wrong_chunk(const ChunkPlace& place, const Message& what) const;

  ChunkObjects objects_;
  ZarrArray array_;
  ChunkGeometry geometry_;
  ObjectScan scan_;
  std::vector<std::unique_ptr<OpenShards>> shards_;  ///< of each level; empty without shards
  std::atomic<std::uint64_t> bytes_read_{0};
};

}  // namespace weir
