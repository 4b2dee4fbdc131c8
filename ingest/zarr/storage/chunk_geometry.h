// Where the voxels of a volume lie in the chunks of a Zarr array.
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

/// A chunk that is decoded alone: a whole object, or one in a shard.
struct ChunkPlace {
  std::vector<std::int64_t> object;  ///< position in the grid of stored objects, of each axis
  std::vector<std::size_t> inner;    ///< in the index of its shard, of the shard in that, ...; empty without shards
  std::vector<std::int64_t> corner;  ///< its first element
};

/// Three axes of an array, at one position on each of those before, and on the one behind, where there is one: the last
/// three, or those before an axis of components.
class ChunkGeometry {
 public:
  /// `index` has a position for each axis before the three, `behind` that on the last axis of an array that has one
  /// more, all inside. Throws Error(input), beginning with `where`, where a chunk has more bytes than any should.
  ChunkGeometry(const ZarrArray& array, const std::vector<std::int64_t>& index, const std::string& where,
                std::optional<std::int64_t> behind = {});

  const Index3& extent() const { return extent_; }
  /// Voxels of what is decoded alone.
  const Index3& unit() const { return unit_; }
  /// Of it, all axes.
  const ChunkShape& unit_shape() const { return unit_shape_; }
  /// Byte of the volume's first voxel in a decoded chunk that is several thick along axes before the three.
  std::size_t first_byte() const { return first_byte_; }
  /// Stored objects that the volume touches, along x, y, z.
  const Index3& objects() const { return objects_; }
  /// Chunks in a shard of each level, those that are objects first; empty without shards.
  const std::vector<std::uint64_t>& chunks_in_shards() const { return chunks_in_shards_; }

  /// Of the chunk at `chunk` (chunk coordinates, in units).
  ChunkPlace place_of(const Index3& chunk) const;
  /// Its ChunkPlace::inner of one level.
  std::size_t place_in_shard(const Index3& chunk, std::size_t level) const;
  /// The units along x, y, z in each of the chunks that shards of that level hold; 1, 1, 1 at the last one.
  Index3 units_in_shard(std::size_t level) const;
  /// Which object it lies in, among objects().
  Index3 object_of(const Index3& chunk) const;
  /// The chunks (chunk coordinates, in units) of an object that have voxels of the volume.
  Box chunks_of(const Index3& object) const;
  /// Those that `voxels`, which lie in the volume, touch.
  Box chunks_at(const Box& voxels) const;
  /// The same as ChunkPlace::object.
  std::vector<std::int64_t> object_position(const Index3& object) const;

 private:
  Index3 of_space(const std::vector<std::int64_t>& elements) const;
  /// The first element, on all axes, of the chunk at `chunk`, with the positions on axes that are not of space.
  std::vector<std::int64_t> element_of(const Index3& chunk) const;

  std::vector<std::int64_t> chunk_;               ///< elements of an object
  std::vector<std::int64_t> units_;               ///< elements of what is decoded alone
  std::vector<std::vector<std::int64_t>> inner_;  ///< elements of the chunks in shards of each level
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

/// "0, 64, 128".
std::string position_text(const std::vector<std::int64_t>& position);

}  // namespace weir
