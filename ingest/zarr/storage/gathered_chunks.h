// The chunks of a volume whose voxels have several numbers, which may lie in several chunks each.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ingest/axes/component_axis.h"
#include "ingest/chunks/chunk_boxes.h"
#include "ingest/chunks/chunk_scratch.h"
#include "ingest/source/component_choice.h"
#include "ingest/zarr/metadata/zarr_array.h"
#include "ingest/zarr/storage/chunk_geometry.h"
#include "ingest/zarr/storage/zarr_chunks.h"

namespace weir {

/// Some of the numbers of each voxel.
struct VoxelPart {
  ChunkGeometry geometry;   ///< of the chunks they lie in
  std::size_t numbers = 1;  ///< that lie beside each other there
  std::size_t used = 1;     ///< of them, from the first on
};

/// All that are read of each voxel.
struct VoxelParts {
  std::vector<VoxelPart> parts;  ///< one or more, of the same voxels in each chunk, in the order of the components
  VoxelComponents components;    ///< beside each other once they are gathered

  /// Whether a chunk of the one part is not what is wanted as it is.
  bool gathers() const { return parts.size() > 1 || parts.front().used != parts.front().numbers; }
  /// Of a chunk of them, gathered; 0 where nothing is.
  std::size_t gathered_bytes() const;
};

/// Where `choice` among the components of `array`, along `axis`, lies; of an array without any its only numbers.
/// `index` has a position on each axis before those of space and components. Throws what ChunkGeometry throws.
VoxelParts voxel_parts(const ZarrArray& array, const std::vector<std::int64_t>& index, const ComponentAxis& axis,
                       const std::optional<ComponentChoice>& choice, const std::string& where);

/// Thread-safe. A chunk that holds several parts is decoded once for all of them.
class GatheredChunks final : public StoredChunks {
 public:
  /// `objects.store` outlives it. Throws what ZarrChunks throws.
  GatheredChunks(const ChunkObjects& objects, const ZarrArray& array, const VoxelParts& parts, std::uint64_t memory,
                 const std::atomic<bool>* cancel);

  /// Of all objects, each once.
  std::string digest() const;
  std::uint64_t object_bytes() const;
  std::int64_t mtime_ns() const;
  /// As ZarrChunks says it.
  std::string key_by_other_separator() const;
  UnstoredChunks count_unstored(const Box& voxels);
  std::uint64_t working_bytes() const;
  std::uint64_t bytes_read() const;

  /// Throws what ZarrChunks::decode throws.
  std::span<const std::byte> decode(const Index3& chunk, ChunkScratch& scratch) override;

 private:
  struct Part {
    std::size_t chunks;  ///< which of chunks_
    std::size_t first_byte;
    std::size_t numbers;
    std::size_t used;
  };

  /// Those of chunks_ that lie in objects of their own.
  std::vector<const ZarrChunks*> of_each_object() const;

  std::size_t value_bytes_;
  std::size_t gathered_bytes_;
  std::size_t voxel_bytes_ = 0;  ///< gathered
  std::vector<std::byte> fill_;  ///< one value
  std::uint64_t store_bytes_;    ///< that the store itself holds
  std::vector<std::unique_ptr<ZarrChunks>> chunks_;
  std::vector<Part> parts_;
};

}  // namespace weir
