// Maps the voxels of a volume to the chunks of a Zarr array.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "format/base/index.h"
#include "ingest/zarr/codecs/codec_chain.h"
#include "ingest/zarr/metadata/zarr_array.h"

namespace weir {

/// The place of a chunk that is decoded alone: a whole object, or a chunk in a shard.
struct ChunkPlace {
  std::vector<std::int64_t> object;  ///< position in the grid of stored objects, on each axis
  std::vector<std::size_t> inner;    ///< index in its shard, first of the outermost shard; empty without shards
  std::vector<std::int64_t> corner;  ///< position of its first element
};

/// A volume of three axes of an array, at one position on each of the other axes. The three axes are the last three,
/// or the three before an axis of components.
class ChunkGeometry {
 public:
  /// `index` has a position for each axis before the three, `behind` the position on the axis after them, if the
  /// array has one. All positions are inside the array. Throws Error(input), beginning with `where`, if a chunk that is
  /// decoded alone has too many bytes, or a shard too many chunks.
  ChunkGeometry(const ZarrArray& array, const std::vector<std::int64_t>& index, const std::string& where,
                std::optional<std::int64_t> behind = {});

  const Index3& extent() const { return extent_; }
  /// Voxels, along x, y, z, of a chunk that is decoded alone.
  const Index3& unit() const { return unit_; }
  /// The shape of a chunk that is decoded alone, on all axes.
  const ChunkShape& unit_shape() const { return unit_shape_; }
  /// Offset in bytes of the volume's first voxel in a decoded chunk. Can exceed 0 only if chunks are several elements
  /// thick along axes before the three.
  std::size_t first_byte() const { return first_byte_; }
  /// The number of stored objects that the volume touches, along x, y, z.
  const Index3& objects() const { return objects_; }
  /// The number of chunks in a shard of each level, outermost first; empty without shards.
  const std::vector<std::uint64_t>& chunks_in_shards() const { return chunks_in_shards_; }

  /// Returns the place of the chunk at `chunk` (chunk coordinates, in units).
  ChunkPlace place_of(const Index3& chunk) const;
  /// Returns the entry of ChunkPlace::inner for one level.
  std::size_t place_in_shard(const Index3& chunk, std::size_t level) const;
  /// Returns the units along x, y, z in each chunk that a shard of `level` holds; 1, 1, 1 at the last level.
  Index3 units_in_shard(std::size_t level) const;
  /// Returns the position, among objects(), of the object that holds `chunk`.
  Index3 object_of(const Index3& chunk) const;
  /// Returns the chunks (chunk coordinates, in units) of an object that have voxels of the volume.
  Box chunks_of(const Index3& object) const;
  /// Returns the chunks that `voxels`, a box inside the volume, touches.
  Box chunks_at(const Box& voxels) const;
  /// Returns the position of `object` in the grid of stored objects, as in ChunkPlace::object.
  std::vector<std::int64_t> object_position(const Index3& object) const;

 private:
  Index3 of_space(const std::vector<std::int64_t>& elements) const;
  /// Returns the first element of the chunk at `chunk` on all axes: `index_` and `behind_` on the axes that are not
  /// of space.
  std::vector<std::int64_t> element_of(const Index3& chunk) const;

  std::vector<std::int64_t> chunk_;               ///< elements of an object
  std::vector<std::int64_t> units_;               ///< elements of a chunk that is decoded alone
  std::vector<std::vector<std::int64_t>> inner_;  ///< for each level of shards, elements of the chunks in a shard
  std::vector<std::int64_t> index_;
  std::optional<std::int64_t> behind_;
  ChunkShape unit_shape_;
  Index3 extent_;
  Index3 unit_;
  Index3 object_;  ///< voxels of an object
  Index3 objects_;
  std::size_t first_byte_ = 0;
  std::vector<std::uint64_t> chunks_in_shards_;
};

/// Returns the position as text: "0, 64, 128".
std::string position_text(const std::vector<std::int64_t>& position);

}  // namespace weir
