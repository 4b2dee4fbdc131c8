// A read-only view of one grid of a NanoVDB file held in memory (mapped or not). open() validates everything before any
// offset is trusted: after it has returned, no call reads outside the span, whatever the bytes are. It walks the
// internal nodes only (some 8 MB of a 1 GB float file), so a file of any size opens without reading its values. All
// calls are const and thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "format/base/index.h"
#include "format/layout/nvdb_type.h"
#include "format/nanovdb/grid_block.h"
#include "format/nanovdb/macrocells.h"
#include "format/nanovdb/nvdb_blind.h"
#include "format/nanovdb/nvdb_header.h"
#include "format/nanovdb/nvdb_tree.h"
#include "format/nanovdb/packed_data.h"

namespace weir {

/// An entry of the root's table: an upper node of 4096^3 voxels, or a value tile of that size.
struct RootEntry {
  Index3 origin;                     ///< lowest voxel
  const std::byte* upper = nullptr;  ///< null: a tile
  bool active = false;               ///< tile state
  float value = 0;                   ///< tile value
};

class NvdbGrid {
 public:
  /// Opens the first grid of `file`, which must stay valid and unchanged while the view is used. `path` is for messages
  /// only. If `release` is given, it is called each time some 8 MiB of nodes have been read, so that a mapped file can
  /// release their pages. Throws Error(input) that names the offset and the value if the file is not a valid,
  /// uncompressed NanoVDB file of a supported type.
  static NvdbGrid open(std::span<const std::byte> file, const std::string& path,
                       const std::function<void()>& release = {});
  /// Opens the grid `record`, which all_nvdb_segments() found.
  static NvdbGrid open(std::span<const std::byte> file, const std::string& path, const NvdbRecord& record,
                       const std::function<void()>& release = {});
  /// Returns the grid of heads that were read and checked. If `file` holds only them and the head of the packed data,
  /// as for a remote grid, the tree must not be read. Throws Error(input) if the head of the packed data is damaged.
  static NvdbGrid of_heads(std::span<const std::byte> file, const std::string& path, const NvdbHeader& header,
                           const NvdbTree& tree, const NvdbBlindData& blind);

  GridType type() const { return type_; }
  const std::string& name() const { return name_; }
  /// Returns the half-open box of the active voxels; in weir's files, the domain. Empty ({}) without active voxels,
  /// otherwise less than 2^62 voxels within the root tiles: check the volume before you allocate memory for it.
  Box index_bbox() const { return bbox_; }
  float background() const { return background_; }
  float value_min() const { return value_min_; }  ///< of the decoded active values, as stored in the root; NaN if its
  float value_max() const { return value_max_; }  ///< writer left the statistics out, and if no value is finite
  std::array<double, 3> voxel_size() const { return voxel_size_; }
  std::array<double, 9> matrix() const { return matrix_; }  ///< row-major: world = matrix * index + world_origin
  std::array<double, 3> world_origin() const { return world_origin_; }  ///< world position of index (0, 0, 0)
  std::uint64_t grid_offset() const { return grid_offset_; }            ///< bytes from the file's start
  std::uint64_t grid_bytes() const { return grid_bytes_; }              ///< gridSize
  /// Returns grid_bytes() without the padding at the end: the end of the last node, blind data record or blind data,
  /// whichever is last. Returns grid_bytes() if blind data has elements of unknown size.
  std::uint64_t data_bytes() const { return data_bytes_; }
  std::uint32_t version() const { return version_; }                         ///< see nvdb_version_text
  std::uint64_t active_voxels() const { return active_voxels_; }             ///< as stored in the tree
  std::array<std::uint32_t, 3> node_counts() const { return node_counts_; }  ///< leaf, lower, upper
  std::array<std::uint32_t, 3> tile_counts() const { return tile_counts_; }  ///< active: lower, upper, root; as stored
  std::uint32_t root_tiles() const { return root_tiles_; }                   ///< entries of the root table
  std::uint32_t head_checksum() const { return head_checksum_; }             ///< all bits set if absent
  MacrocellView macrocells() const { return macrocells_; }

  /// Returns the packed data, or null. If there is packed data, it holds the volume, and the tree is only what readers
  /// see that do not know packed data. Then value_min(), value_max() and the macrocells describe the decoded values,
  /// and node_counts(), tile_counts() and active_voxels() describe the tree; all voxels inside index_bbox() are active.
  const PackedData* packed() const { return packed_.get(); }

  /// Returns what covers voxel `i` (any coordinates), in the packed data if there is any. Throws as
  /// PackedData::stream().
  GridBlock block_at(const Index3& i) const;
  /// Returns the decoded value of voxel `i`, the same as a stock accessor; for a packed grid, the background outside
  /// index_bbox(). Slow for a packed grid, because it decodes the whole block. Throws as decode_block().
  float value(const Index3& i) const;
  /// Decodes the 512 values of a block of dim 8, or of any 8^3 voxels of a larger block, index x<<6 | y<<3 | z (z
  /// fastest): from its leaf or stream, or its one value. Values of a packed grid outside index_bbox() have no meaning.
  /// Throws as decode_leaf() and PackedData::decode().
  void decode_block(const GridBlock& block, std::span<float, 512> values) const;
  /// Decodes leaf `block.leaf` into 512 values in the order of decode_block(). Throws Error(input) if the width of an
  /// FpN leaf is invalid, because open() does not read it.
  void decode_leaf(const std::byte* leaf, std::span<float, 512> values) const;
  /// Returns the bits a voxel of a leaf: 1, 2, 4, 8, 16 or 32. Throws as decode_leaf().
  unsigned leaf_bits(const std::byte* leaf) const;
  /// Calls `visit` for every entry of the root's table, in file order; for a packed grid, too, of its tree.
  void for_each_root_entry(const std::function<void(const RootEntry&)>& visit) const;
  /// Calls `visit` for every leaf and every value tile in file order: root tiles, then per upper node its tiles and
  /// children. Inactive tiles of background value are visited too. For a packed grid: visits the blocks of its packed
  /// data that touch index_bbox(), and throws as PackedData::stream().
  void for_each_block(const std::function<void(const GridBlock&)>& visit) const;
  /// Like for_each_block(), but always visits the tree, which other readers see, even if the grid is packed.
  void for_each_tree_block(const std::function<void(const GridBlock&)>& visit) const;

  std::span<const std::byte> bytes() const { return file_; }  ///< the whole file
  /// Returns the grid without its padding: the bytes that a copy of the grid needs.
  std::span<const std::byte> data() const { return file_.subspan(grid_offset_, data_bytes_); }

 private:
  NvdbGrid() = default;

  GridBlock tree_block_at(const Index3& i) const;
  static void visit_upper(const Index3& origin, const std::byte* upper,
                          const std::function<void(const GridBlock&)>& visit);

  std::span<const std::byte> file_;
  std::string path_;
  std::uint32_t version_ = 0;
  GridType type_ = GridType::float32;
  std::string name_;
  Box bbox_;
  float background_ = 0;
  float value_min_ = 0;
  float value_max_ = 0;
  std::array<double, 3> voxel_size_{};
  std::array<double, 9> matrix_{};
  std::array<double, 3> world_origin_{};
  std::uint64_t grid_offset_ = 0;
  std::uint64_t grid_bytes_ = 0;
  std::uint64_t data_bytes_ = 0;
  std::uint64_t active_voxels_ = 0;
  std::array<std::uint32_t, 3> node_counts_{};
  std::array<std::uint32_t, 3> tile_counts_{};
  std::uint32_t root_tiles_ = 0;
  std::uint32_t head_checksum_ = 0;
  MacrocellView macrocells_;
  std::shared_ptr<const PackedData> packed_;
};

}  // namespace weir
