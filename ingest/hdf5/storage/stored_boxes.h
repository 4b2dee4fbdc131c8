// Sources whose library hands out stored values box by box, one call at a time:
// the way for whatever has no faster one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "format/base/index.h"
#include "ingest/source/component_choice.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Bytes that are read at a time: more saves no time.
inline constexpr std::uint64_t kAmpleBuffer = std::uint64_t{4} << 20U;

/// Chunks that are read at a time: for each the library keeps its parts of the selections, and for so many no read
/// takes longer than one of all.
inline constexpr std::int64_t kMostChunks = 512;
/// What it keeps for a chunk.
inline constexpr std::uint64_t kBytesOfChunk = 8192;

/// Where stored values come from. One thread at a time.
class StoredBoxes {
 public:
  virtual ~StoredBoxes() = default;

  /// Fills `stored` with the values of `box` as they are stored, x fastest, the components of a voxel side by side.
  /// Throws Error(input).
  virtual void read(const Box& box, std::span<std::byte> stored) = 0;
  /// The grid that boxes should be cut at, so that no chunk is decoded for two of them: extent (zero where
  /// there is none) and a corner.
  virtual Index3 chunk() const = 0;
  virtual Index3 chunk_origin() const { return {0, 0, 0}; }
  /// Paths of the files that values come from, besides the one that was opened.
  virtual std::vector<std::string> files() const { return {}; }
  /// What it and its library hold besides, in bytes.
  virtual std::uint64_t working_bytes() const = 0;
};

/// Fills `stored` with copies of `value`, whose bytes divide its own.
void repeat_value(std::span<const std::byte> value, std::span<std::byte> stored);

/// A source of `info`, whose domain begins at index 0, with `components` of info.type each voxel. Reads in pieces of
/// whole chunks, at most kMostChunks, through one buffer that takes at most a sixteenth of `memory` bytes or one chunk.
/// Throws Error(usage), naming `where` and a sufficient --memory, where chunks need more than half of it.
std::unique_ptr<VolumeSource> make_stored_box_source(std::unique_ptr<StoredBoxes> boxes, SourceInfo info,
                                                     bool big_endian, std::uint64_t memory, const std::string& where,
                                                     const VoxelComponents& components = {});

/// The parts of `box` between planes of the grid of `unit` voxels with a corner at `corner`: as many whole
/// units together as `voxels` hold, at most `most_units`, along x first, then y, then z; one where even that is more.
class BoxCuts {
 public:
  /// unit >= 1 along each axis; `box` is not empty.
  BoxCuts(const Box& box, const Index3& unit, const Index3& corner, std::int64_t voxels,
          std::int64_t most_units = std::numeric_limits<std::int64_t>::max());

  std::int64_t size() const { return volume(count_); }
  /// Voxels of the largest part.
  std::int64_t most_voxels() const { return volume(min(part_, box_.extent())); }
  /// x fastest, then y, then z; never empty.
  Box part(std::int64_t i) const;

 private:
  Box box_;
  Index3 part_;   ///< voxels
  Index3 first_;  ///< corner of the first part, at or before box_.lo
  Index3 count_;
};

}  // namespace weir
