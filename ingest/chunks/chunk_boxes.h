// Boxes of a volume that is stored in chunks, whatever format they lie in: each chunk that a box touches is decoded
// once, by TBB's workers, in bounded memory.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "format/base/index.h"
#include "format/base/scalar_type.h"
#include "ingest/chunks/chunk_scratch.h"
#include "ingest/source/component_choice.h"
#include "ingest/source/stored_value.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// A volume and the chunks it is cut into, whose first one begins at voxel (0, 0, 0).
struct ChunkedVolume {
  std::string name;  ///< messages begin with it
  Index3 extent;     ///< voxels
  Index3 chunk;      ///< voxels, each >= 1
  ScalarType type = ScalarType::float32;
  bool big_endian = false;
  ValueMapping mapping;
  VoxelComponents components = {};  ///< of each voxel, beside each other in a chunk
  std::vector<std::byte> fill;      ///< one stored value: what voxels of chunks that are not stored read as

  std::size_t voxel_bytes() const { return scalar_bytes(type) * static_cast<std::size_t>(components.count); }
};

/// Where chunks come from. Thread-safe.
class StoredChunks {
 public:
  virtual ~StoredChunks() = default;

  /// The voxels of the chunk at `chunk` (chunk coordinates), x fastest, as they were before they were packed, which lie
  /// in `scratch`: ChunkedVolume::chunk of them, those beyond the volume too. Empty where the chunk is not stored.
  /// Throws Error(input), naming the chunk.
  virtual std::span<const std::byte> decode(const Index3& chunk, ChunkScratch& scratch) = 0;
};

/// Thread-safe.
class ChunkBoxes {
 public:
  /// `chunks` and `scratch` outlive it.
  ChunkBoxes(ChunkedVolume volume, StoredChunks& chunks, ScratchPool& scratch);

  const ChunkedVolume& volume() const { return volume_; }
  /// Chunk extent in voxels and bytes per voxel, for the block plan.
  AccessShape access() const { return {volume_.voxel_bytes(), volume_.chunk, {}}; }

  /// Reads `box` (inside the volume, not empty) into `values`, x fastest. Every chunk it touches is decoded once.
  /// Throws what StoredChunks::decode throws.
  ConversionLoss read(const Box& box, std::span<float> values);

 private:
  /// The part of `box` that the chunk at `chunk` holds.
  ConversionLoss read_chunk(const Index3& chunk, const Box& box, std::span<float> values, ChunkScratch& scratch);

  ChunkedVolume volume_;
  StoredChunks& chunks_;
  ScratchPool& scratch_;
  float fill_ = 0;
  ConversionLoss fill_loss_;  ///< of one voxel
};

}  // namespace weir
