// Reads boxes of a volume that is stored in chunks, in any format. TBB's workers decode each chunk that a box touches
// once, in bounded memory.
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

/// A volume and its chunks. The first chunk begins at voxel (0, 0, 0).
struct ChunkedVolume {
  std::string name;  ///< messages begin with this name
  Index3 extent;     ///< voxels
  Index3 chunk;      ///< voxels, each >= 1
  ScalarType type = ScalarType::float32;
  bool big_endian = false;
  ValueMapping mapping;
  VoxelComponents components = {};  ///< components of each voxel, side by side in a chunk
  std::vector<std::byte> fill;      ///< one stored value, which voxels of chunks that are not stored read as

  std::size_t voxel_bytes() const { return scalar_bytes(type) * static_cast<std::size_t>(components.count); }
};

/// The source of decoded chunks. Thread-safe.
class StoredChunks {
 public:
  virtual ~StoredChunks() = default;

  /// Returns the decoded voxels of the chunk at `chunk` (chunk coordinates), x fastest. They lie in `scratch`. There
  /// are always ChunkedVolume::chunk of them, including those beyond the volume's border. Returns an empty span if
  /// the chunk is not stored. Throws Error(input), naming the chunk.
  virtual std::span<const std::byte> decode(const Index3& chunk, ChunkScratch& scratch) = 0;
};

/// Reads boxes of one chunked volume. Thread-safe.
class ChunkBoxes {
 public:
  /// `chunks` and `scratch` must outlive this object.
  ChunkBoxes(ChunkedVolume volume, StoredChunks& chunks, ScratchPool& scratch);

  const ChunkedVolume& volume() const { return volume_; }
  /// Returns the chunk extent in voxels and the bytes per voxel, for the block plan.
  AccessShape access() const { return {volume_.voxel_bytes(), volume_.chunk, {}}; }

  /// Reads `box` (inside the volume, not empty) into `values`, x fastest. Every chunk that it touches is decoded
  /// once. Throws what StoredChunks::decode throws.
  ConversionLoss read(const Box& box, std::span<float> values);

 private:
  /// Reads the part of `box` that the chunk at `chunk` holds.
  ConversionLoss read_chunk(const Index3& chunk, const Box& box, std::span<float> values, ChunkScratch& scratch);

  ChunkedVolume volume_;
  StoredChunks& chunks_;
  ScratchPool& scratch_;
  float fill_ = 0;
  ConversionLoss fill_loss_;  ///< conversion loss of one fill voxel
};

}  // namespace weir
