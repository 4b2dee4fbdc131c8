// Where the voxels are: a flat table of the 8^3 blocks over the domain, with 4 bytes per block, built once at load.
// An entry below tile_count is an index into the tile values. Any other entry is a leaf: (offset from `leaves`) / 32
// + tile_count. One look-up and one load replace a standard accessor's walk from the root. LeafTable owns the table.
// The leaves stay in the mapped file, or are decoded into memory if the file is packed (cached_blocks.h: into a
// cache).
#pragma once

#include <cstdlib>
#include <memory>
#include <vector>

#include "format/leaf/leaf_decode.h"
#include "format/nanovdb/nvdb_grid.h"
#include "gpu/math/vector3.h"
#include "gpu/volume/decoded_leaves.h"

namespace weir {

/// Returns `i`, or the next voxel if `up` is set and there is one.
WEIR_HOST_DEVICE inline std::int32_t upper(std::int32_t i, bool up, std::int32_t extent) {
  return up && i + 1 < extent ? i + 1 : i;
}

/// The resolved entry of a block: the leaf's bytes, or null and the value of the whole block.
struct LeafBlock {
  const std::byte* leaf = nullptr;
  float value = 0;
};

/// The part of a LeafTable that a kernel needs; pointers may be to host or device memory. Voxel coordinates are
/// local: 0 is the lowest voxel of the domain.
struct LeafTableView {
  const std::uint32_t* entries = nullptr;  ///< count.x * count.y * count.z, x fastest
  const float* tile_values = nullptr;      ///< tile_count values; [0] is the background
  const std::byte* leaves = nullptr;       ///< 32-byte aligned
  Int3 count;                              ///< blocks along each axis
  Int3 shift;                              ///< local + shift = voxels from the first block's corner, in [0, 8)
  Int3 extent;                             ///< voxels of the domain
  std::uint32_t tile_count = 0;
  GridType type = GridType::float32;

  /// Returns the block that covers voxel `v`, given as coordinates from the first block's corner.
  WEIR_HOST_DEVICE LeafBlock block(const Int3& v) const {
    const std::uint32_t entry = entries[table_index({v.x >> 3, v.y >> 3, v.z >> 3}, count)];
    if (entry < tile_count) return {nullptr, tile_values[entry]};
    return {leaves + 32 * static_cast<std::size_t>(entry - tile_count), 0.0F};
  }

  /// Returns the local voxel `i` as coordinates from the first block's corner.
  WEIR_HOST_DEVICE Int3 from_corner(const Int3& i) const { return {i.x + shift.x, i.y + shift.y, i.z + shift.z}; }

  /// Returns whether the 2 x 2 x 2 voxels from the local voxel `i` up lie in one block; `v` is from_corner(i). This
  /// is so for two of three positions. One look-up then serves all eight voxels.
  WEIR_HOST_DEVICE bool taps_in_one_block(const Int3& i, const Int3& v) const {
    return (v.x & 7) < 7 && (v.y & 7) < 7 && (v.z & 7) < 7 && i.x + 1 < extent.x && i.y + 1 < extent.y &&
           i.z + 1 < extent.z;
  }

  /// Returns the value of the local voxel `i`, 0 <= i < extent.
  WEIR_HOST_DEVICE float voxel(const Int3& i) const {
    const Int3 v = from_corner(i);
    const LeafBlock b = block(v);
    return b.leaf == nullptr ? b.value : leaf_value(type, b.leaf, offset_in_leaf(v));
  }

  /// Reads the 2 x 2 x 2 voxels from the local voxel `i` up, x fastest, clamped to the extent. Returns true if one
  /// tile covers all of them; then only c[0] is set.
  WEIR_HOST_DEVICE bool taps(const Int3& i, float (&c)[8]) const {
    const Int3 v = from_corner(i);
    if (taps_in_one_block(i, v)) {
      const LeafBlock b = block(v);
      if (b.leaf == nullptr) {
        c[0] = b.value;
        return true;
      }
      const std::uint32_t o = offset_in_leaf(v);
      for (std::uint32_t k = 0; k < 8; ++k) {
        c[k] = leaf_value(type, b.leaf, o + ((k & 1U) << 6U) + ((k & 2U) << 2U) + (k >> 2U));
      }
    } else {
      for (int k = 0; k < 8; ++k) {
        c[k] = voxel({upper(i.x, (k & 1) != 0, extent.x), upper(i.y, (k & 2) != 0, extent.y),
                      upper(i.z, (k & 4) != 0, extent.z)});
      }
    }
    return false;
  }

  WEIR_HOST_DEVICE static std::uint32_t offset_in_leaf(const Int3& v) {
    return static_cast<std::uint32_t>((v.x & 7) << 6 | (v.y & 7) << 3 | (v.z & 7));
  }
};

/// Returns the blocks over a domain. Throws Error(input) if the domain is empty or has more than 2^31 blocks.
NodeLattice leaf_lattice(const Box& domain);

/// Throws Error(input) if `tiles` tile values (background included) and leaves up to `units` units of 32 bytes after
/// the first do not fit a table's 32-bit entries.
void check_entry_range(std::uint64_t tiles, std::uint64_t units);

/// How a LeafTable treats the coded blocks of a packed grid: decodes them to leaves in memory, or marks their entries
/// as neither tile nor leaf, for a reader that decodes them itself.
enum class CodedBlocks { decoded, marked };

/// Returns the most tile values that the table of a packed grid has: one per region, because its blocks without a
/// stream have the same value, and the background.
std::uint64_t most_packed_tiles(const PackedData& packed);

class LeafTable {
 public:
  /// Builds the table over grid.index_bbox(). `grid`'s bytes must outlive the object. Throws Error(input) if the
  /// domain is empty, has more than 2^31 blocks, or leaves and tiles exceed 32 bits. If the blocks of a packed grid
  /// are decoded, also throws the errors of DecodedLeaves.
  explicit LeafTable(const NvdbGrid& grid, CodedBlocks coded = CodedBlocks::decoded);

  LeafTableView view() const { return view_; }
  const Box& domain() const { return lattice_.domain; }
  std::uint64_t bytes() const;  ///< bytes of the table, the tile values and the decoded leaves

 private:
  struct Free {
    void operator()(std::uint32_t* p) const { std::free(p); }
  };

  void add(const GridBlock& block, std::uint32_t entry);
  void add_tiles(const NvdbGrid& grid);
  void mark_coded(const NvdbGrid& grid);
  // Both return where the leaves begin.
  const std::byte* add_stored(const NvdbGrid& grid);
  const std::byte* add_decoded(const NvdbGrid& grid);

  NodeLattice lattice_;
  std::unique_ptr<std::uint32_t[], Free> entries_;
  std::vector<float> tile_values_;
  DecodedLeaves decoded_;  ///< leaves of a packed grid
  LeafTableView view_;
};

}  // namespace weir
