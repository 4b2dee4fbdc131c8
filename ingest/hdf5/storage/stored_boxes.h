// Sources for data that a library hands out box by box, one call at a time. Used for all data without a faster
// reader.
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

/// The most bytes that are read at a time; more saves no time.
inline constexpr std::uint64_t kAmpleBuffer = std::uint64_t{4} << 20U;

/// The most chunks that are read at a time. The library keeps its parts of the selections for each chunk. With this
/// many chunks a read takes no longer than one read of all chunks.
inline constexpr std::int64_t kMostChunks = 512;
/// The bytes that the library keeps for each chunk.
inline constexpr std::uint64_t kBytesOfChunk = 8192;

/// A supplier of stored values. Used by one thread at a time.
class StoredBoxes {
 public:
  virtual ~StoredBoxes() = default;

  /// Fills `stored` with the values of `box` as they are stored, x fastest, the components of a voxel side by side.
  /// Throws Error(input).
  virtual void read(const Box& box, std::span<std::byte> stored) = 0;
  /// The extent of the chunks (zero if there are none), and a corner of their grid. Callers cut boxes at this grid so
  /// that no chunk is decoded for two boxes.
  virtual Index3 chunk() const = 0;
  virtual Index3 chunk_origin() const { return {0, 0, 0}; }
  /// Returns the paths of the files that values come from, besides the opened file.
  virtual std::vector<std::string> files() const { return {}; }
  /// Returns the bytes that this object and its library hold in addition.
  virtual std::uint64_t working_bytes() const = 0;
};

/// Fills `stored` with copies of `value`. The size of `stored` is a multiple of the size of `value`.
void repeat_value(std::span<const std::byte> value, std::span<std::byte> stored);

/// Returns a source of `info`. Its domain begins at index 0, and each voxel has `components` values of info.type. It
/// reads pieces of whole chunks, at most kMostChunks, through one buffer of at most a sixteenth of `memory` bytes or
/// one chunk. Throws Error(usage), naming `where` and a sufficient --memory, if chunks need more than half of
/// `memory`.
std::unique_ptr<VolumeSource> make_stored_box_source(std::unique_ptr<StoredBoxes> boxes, SourceInfo info,
                                                     bool big_endian, std::uint64_t memory, const std::string& where,
                                                     const VoxelComponents& components = {});

/// Cuts `box` into parts at the planes of a grid of `unit` voxels with a corner at `corner`. A part joins as many
/// whole units as fit in `voxels`, at most `most_units`: along x first, then y, then z. If one unit exceeds `voxels`,
/// a part is one unit.
class BoxCuts {
 public:
  /// `unit` is at least 1 along each axis; `box` is not empty.
  BoxCuts(const Box& box, const Index3& unit, const Index3& corner, std::int64_t voxels,
          std::int64_t most_units = std::numeric_limits<std::int64_t>::max());

  std::int64_t size() const { return volume(count_); }
  /// Voxels of the largest part.
  std::int64_t most_voxels() const { return volume(min(part_, box_.extent())); }
  /// Returns part `i`, which is never empty. Parts are counted with x fastest, then y, then z.
  Box part(std::int64_t i) const;

 private:
  Box box_;
  Index3 part_;   ///< voxels
  Index3 first_;  ///< corner of the first part, at or before box_.lo
  Index3 count_;
};

}  // namespace weir
