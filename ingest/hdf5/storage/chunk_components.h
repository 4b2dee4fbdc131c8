// The components of a voxel and the chunks that they lie in: along an array's last axis a chunk may hold some of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "ingest/source/component_choice.h"

namespace weir {

/// Which chunks along the last axis are read, and the numbers of each voxel that come out.
struct ChunkComponents {
  std::int64_t in_chunk = 1;  ///< numbers of each voxel in one chunk, side by side
  std::int64_t first = 0;     ///< the first component of the chunk that is read; 0 if chunks are gathered
  VoxelComponents read;       ///< numbers of each voxel in the chunk that is read, or after gathering

  /// Returns whether the numbers of a voxel must be gathered from several chunks, or from one that holds more.
  bool gathers() const { return read.count != in_chunk; }
  /// Returns the bytes of a gathered voxel.
  std::size_t voxel_bytes(std::size_t value_bytes) const { return static_cast<std::size_t>(read.count) * value_bytes; }
};

/// Returns the chunks that the choice of `components` needs, where each chunk holds `in_chunk` (>= 1) numbers of a
/// voxel. One component needs the chunk that holds it; the magnitude needs all.
ChunkComponents chunk_components(const VoxelComponents& components, std::int64_t in_chunk);

/// Puts the numbers of each voxel side by side that several chunks hold.
class ComponentGathering {
 public:
  /// `components` gathers. `fill` is one stored value, which numbers of missing chunks read as. `into` has the
  /// gathered voxels of one chunk.
  ComponentGathering(const ChunkComponents& components, std::span<const std::byte> fill, std::span<std::byte> into);

  /// Adds the next chunk along the last axis: all its voxels, or none if the file does not hold it. Call it once for
  /// each chunk.
  void add(std::span<const std::byte> chunk);
  /// Returns the gathered voxels; an empty span if the file holds none of the chunks.
  std::span<const std::byte> gathered() const;

 private:
  const ChunkComponents& components_;
  std::span<const std::byte> fill_;
  std::span<std::byte> into_;
  std::int64_t done_ = 0;  ///< components
  bool any_stored_ = false;
};

}  // namespace weir
