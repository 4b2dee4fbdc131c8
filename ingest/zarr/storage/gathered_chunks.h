// The chunks of a volume with several numbers per voxel. The numbers of a voxel may lie in several chunks.
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

/// Some of the numbers of each voxel: those that lie in one chunk.
struct VoxelPart {
  ChunkGeometry geometry;   ///< of the chunks with these numbers
  std::size_t numbers = 1;  ///< of a voxel that lie side by side in its chunk
  std::size_t used = 1;     ///< how many of these are read, from the first on
};

/// All numbers that are read of each voxel.
struct VoxelParts {
  std::vector<VoxelPart> parts;  ///< one or more, in component order; all have the same voxels in each chunk
  VoxelComponents components;    ///< side by side, after gathering

  /// Returns whether chunks must be gathered: there are several parts, or only some numbers of the one part are used.
  bool gathers() const { return parts.size() > 1 || parts.front().used != parts.front().numbers; }
  /// Returns the bytes of one gathered chunk; 0 if nothing is gathered.
  std::size_t gathered_bytes() const;
};

/// Returns the parts of `array` that `choice` needs, a choice among the components along `axis`. An array without
/// components has one part, its only numbers. `index` has a position on each axis before the axes of space and
/// components. Throws the errors of ChunkGeometry.
VoxelParts voxel_parts(const ZarrArray& array, const std::vector<std::int64_t>& index, const ComponentAxis& axis,
                       const std::optional<ComponentChoice>& choice, const std::string& where);

/// Decodes and gathers chunks. Thread-safe. A chunk that holds several parts is decoded once for all of them.
class GatheredChunks final : public StoredChunks {
 public:
  /// `objects.store` must outlive this object. Throws the errors of ZarrChunks.
  GatheredChunks(const ChunkObjects& objects, const ZarrArray& array, const VoxelParts& parts, std::uint64_t memory,
                 const std::atomic<bool>* cancel);

  /// The digest, bytes and newest mtime of all objects, each object counted once.
  std::string digest() const;
  std::uint64_t object_bytes() const;
  std::int64_t mtime_ns() const;
  /// See ZarrChunks.
  std::string key_by_other_separator() const;
  UnstoredChunks count_unstored(const Box& voxels);
  std::uint64_t working_bytes() const;
  std::uint64_t bytes_read() const;

  /// Throws the errors of ZarrChunks::decode.
  std::span<const std::byte> decode(const Index3& chunk, ChunkScratch& scratch) override;

 private:
  struct Part {
    std::size_t chunks;  ///< index in chunks_
    std::size_t first_byte;
    std::size_t numbers;
    std::size_t used;
  };

  /// Returns the entries of chunks_ that lie in different objects.
  std::vector<const ZarrChunks*> of_each_object() const;

  std::size_t value_bytes_;
  std::size_t gathered_bytes_;
  std::size_t voxel_bytes_ = 0;  ///< of a gathered voxel
  std::vector<std::byte> fill_;  ///< one value
  std::uint64_t store_bytes_;    ///< bytes that the store itself holds
  std::vector<std::unique_ptr<ZarrChunks>> chunks_;
  std::vector<Part> parts_;
};

}  // namespace weir
