// Reads and decodes the chunks of a volume in a Zarr array one by one.
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

/// A count of chunks that are not stored.
struct UnstoredChunks {
  std::uint64_t count = 0;
  std::uint64_t all = 0;  ///< chunks that were asked about
  std::string first;      ///< "run.zarr/rho/c/0/0/1: chunk at 0, 0, 64"; empty if all are stored
};

/// The chunks at one position on the axes that are not of space (ChunkGeometry). Thread-safe.
class ZarrChunks final : public StoredChunks {
 public:
  /// `objects.store` must outlive this object. Throws the errors of scan_objects and OpenShards.
  ZarrChunks(ChunkObjects objects, ZarrArray array, ChunkGeometry geometry, std::uint64_t memory,
             const std::atomic<bool>* cancel);

  const ObjectScan& scan() const { return scan_; }
  const ChunkGeometry& geometry() const { return geometry_; }
  std::string key_by_other_separator() const { return weir::key_by_other_separator(objects_, geometry_, scan_); }
  /// Counts the chunks that `voxels` touches, and how many of them are not stored. Reads the index of every stored
  /// shard that has touched chunks. Throws the errors that decode() throws for an index.
  UnstoredChunks count_unstored(const Box& voxels);
  std::uint64_t working_bytes() const;
  std::uint64_t bytes_read() const { return bytes_read_; }

  /// Throws Error(input), naming the object and the chunk's first element, if the chunk is too large or damaged, or
  /// if its object is gone or was changed since the scan.
  std::span<const std::byte> decode(const Index3& chunk, ChunkScratch& scratch) override;
  /// Decodes a chunk like decode(), but keeps the bytes before the volume's first voxel in a chunk that is several
  /// elements thick along other axes.
  std::span<const std::byte> decode_whole(const Index3& chunk, ChunkScratch& scratch);

 private:
  /// Opens the object `key`. Throws if it was changed since the scan or is gone.
  std::unique_ptr<ZarrObject> open_unchanged(const std::string& key) const;
  /// Returns the shard that is the whole object at `key`.
  std::shared_ptr<const OpenShard> outer_shard(const std::string& key);
  /// Returns the shard at path.back() in the shard `around`, which lies at the rest of `path` in the object `outer`;
  /// nullptr if it is not stored.
  std::shared_ptr<const OpenShard> inner_shard(const OpenShard& outer, const OpenShard& around,
                                               std::span<const std::size_t> path);
  void count_unstored_in(const OpenShard& outer, const OpenShard& around, const Box& chunks,
                         std::vector<std::size_t>& path, UnstoredChunks& unstored);
  /// Adds all `chunks`, which lie in one object, to `unstored`.
  void add_unstored(const Box& chunks, UnstoredChunks& unstored) const;
  /// Reads the stored bytes of the chunk into the front of `into` and returns their number; nullopt if its shard does
  /// not have it.
  std::optional<std::size_t> fetch(const ChunkPlace& place, std::span<std::byte> into);
  /// Returns the chunk's first element as text, without the axes that the array does not have.
  std::string corner_text(const ChunkPlace& place) const;
  Error wrong_chunk(const ChunkPlace& place, const Message& what) const;

  ChunkObjects objects_;
  ZarrArray array_;
  ChunkGeometry geometry_;
  ObjectScan scan_;
  std::vector<std::unique_ptr<OpenShards>> shards_;  ///< one for each level; empty without shards
  std::atomic<std::uint64_t> bytes_read_{0};
};

}  // namespace weir
