#include "format/nanovdb/nvdb_grid.h"

#include <algorithm>
#include <limits>

#include "format/layout/nanovdb_layout.h"
#include "format/leaf/leaf_decode.h"
#include "format/nanovdb/nvdb_blind.h"
#include "format/nanovdb/nvdb_bytes.h"
#include "format/nanovdb/nvdb_tree.h"
#include "format/nanovdb/packed_blocks.h"

namespace weir {
namespace {

using nvdb::InternalLayout;

bool mask_on(const std::byte* mask, unsigned n) {
  return ((static_cast<unsigned>(mask[n >> 3U]) >> (n & 7U)) & 1U) != 0;
}

// Returns the position of voxel `i` in the table of an internal node with `side` entries along an edge, each `dim`
// voxels long: x-major, z fastest.
unsigned entry_index(const Index3& i, std::int64_t dim, std::int64_t side) {
  const auto axis = [dim, side](std::int64_t v) { return floor_div(v, dim) & (side - 1); };
  return static_cast<unsigned>((axis(i.x) * side + axis(i.y)) * side + axis(i.z));
}

Index3 entry_offset(unsigned n, std::int64_t dim, std::int64_t side) {
  const auto e = static_cast<std::int64_t>(n);
  return Index3{e / (side * side), e / side % side, e % side} * dim;
}

GridBlock internal_tile(const std::byte* node, const InternalLayout& layout, unsigned n, const Index3& origin,
                        std::int64_t dim) {
  return {origin, dim, mask_on(node + layout.value_mask, n), load<float>(node + layout.table + 8 * std::size_t{n}),
          nullptr};
}

bool int32_range(const Index3& i) {
  const auto axis = [](std::int64_t v) {
    return v >= std::numeric_limits<std::int32_t>::min() && v <= std::numeric_limits<std::int32_t>::max();
  };
  return axis(i.x) && axis(i.y) && axis(i.z);
}

const std::byte* child_of(const std::byte* node, const InternalLayout& layout, unsigned n) {
  return node + load<std::int64_t>(node + layout.table + 8 * std::size_t{n});
}

void check_packable(const NvdbBytes& grid, GridType type) {
  if (type == GridType::float32) return;
  grid.fail(nvdb::grid::kGridType, "packed data in a grid of type ", grid_type_name(type), " instead of float32");
}

}  // namespace

NvdbGrid NvdbGrid::open(std::span<const std::byte> file, const std::string& path,
                        const std::function<void()>& release) {
  return open(file, path, first_nvdb_segment(file, path).front(), release);
}

NvdbGrid NvdbGrid::open(std::span<const std::byte> file, const std::string& path, const NvdbRecord& record,
                        const std::function<void()>& release) {
  const NvdbHeader header = read_nvdb_header(file, path, record);
  const NvdbBytes bytes(file.subspan(header.grid_offset, header.grid_bytes), header.grid_offset, path);
  const NvdbTree tree = read_nvdb_tree(bytes, header.type, release);
  return of_heads(file, path, header, tree, read_nvdb_blind_data(bytes, tree.end, tree.bbox));
}

NvdbGrid NvdbGrid::of_heads(std::span<const std::byte> file, const std::string& path, const NvdbHeader& header,
                            const NvdbTree& tree, const NvdbBlindData& blind) {
  const NvdbBytes bytes(file.subspan(header.grid_offset, header.grid_bytes), header.grid_offset, path);
  NvdbGrid grid;
  grid.file_ = file;
  grid.path_ = path;
  grid.version_ = header.version;
  grid.type_ = header.type;
  grid.name_ = header.name;
  grid.bbox_ = tree.bbox;
  grid.background_ = bytes.get<float>(nvdb::kRootOffset + nvdb::root::kBackground);
  grid.value_min_ = bytes.get<float>(nvdb::kRootOffset + nvdb::root::kMin);
  grid.value_max_ = bytes.get<float>(nvdb::kRootOffset + nvdb::root::kMax);
  if (!header.has_min_max || grid.value_min_ > grid.value_max_) {
    grid.value_min_ = grid.value_max_ = std::numeric_limits<float>::quiet_NaN();
  }
  grid.voxel_size_ = header.voxel_size;
  grid.matrix_ = header.matrix;
  grid.world_origin_ = header.world_origin;
  grid.grid_offset_ = header.grid_offset;
  grid.grid_bytes_ = header.grid_bytes;
  grid.data_bytes_ = blind.end;
  grid.active_voxels_ = tree.active_voxels;
  grid.node_counts_ = tree.node_counts;
  grid.tile_counts_ = tree.tile_counts;
  grid.root_tiles_ = tree.root_tiles;
  grid.head_checksum_ = bytes.get<std::uint32_t>(nvdb::grid::kChecksum);
  grid.macrocells_ = blind.macrocells;
  if (blind.packed_bytes != 0) {
    check_packable(bytes, header.type);
    const std::uint64_t at = header.grid_offset + blind.packed;
    grid.packed_ = std::make_shared<const PackedData>(file.subspan(at, blind.packed_bytes), at, path, tree.bbox);
  }
  return grid;
}

GridBlock NvdbGrid::block_at(const Index3& i) const {
  return packed_ ? packed_block_at(*packed_, background_, i) : tree_block_at(i);
}

GridBlock NvdbGrid::tree_block_at(const Index3& i) const {
  const std::byte* grid = data().data();
  const GridBlock outside{floor_div(i, kUpperDim) * kUpperDim, kUpperDim, false, background_, nullptr};
  if (!int32_range(i)) return outside;
  for (std::uint32_t t = 0; t < root_tiles_; ++t) {
    const std::byte* tile = grid + nvdb::kRootTilesOffset + t * nvdb::kRootTileBytes;
    if (root_tile_origin(load<std::uint64_t>(tile + nvdb::root::kTileKey)) != outside.origin) continue;
    const auto child = load<std::int64_t>(tile + nvdb::root::kTileChild);
    if (child == 0) {
      return {outside.origin, kUpperDim, load<std::uint32_t>(tile + nvdb::root::kTileState) != 0,
              load<float>(tile + nvdb::root::kTileValue), nullptr};
    }
    const std::byte* upper = grid + nvdb::kRootOffset + child;
    const unsigned u = entry_index(i, kLowerDim, kUpperLowers);
    if (!mask_on(upper + nvdb::kUpper.child_mask, u)) {
      return internal_tile(upper, nvdb::kUpper, u, floor_div(i, kLowerDim) * kLowerDim, kLowerDim);
    }
    const std::byte* lower = child_of(upper, nvdb::kUpper, u);
    const unsigned l = entry_index(i, kLeafDim, kLowerLeaves);
    const Index3 origin = floor_div(i, kLeafDim) * kLeafDim;
    if (!mask_on(lower + nvdb::kLower.child_mask, l)) return internal_tile(lower, nvdb::kLower, l, origin, kLeafDim);
    return {origin, kLeafDim, true, 0, child_of(lower, nvdb::kLower, l)};
  }
  return outside;
}

float NvdbGrid::value(const Index3& i) const {
  if (packed_ && !bbox_.contains(i)) return background_;
  const GridBlock block = block_at(i);
  if (!block.coded()) return block.value;
  const unsigned at = entry_index(i, 1, kLeafDim);
  if (block.leaf != nullptr) {
    leaf_bits(block.leaf);
    return leaf_value(type_, block.leaf, at);
  }
  std::array<float, kLeafVoxels> values;
  packed_->decode(block.stream, values);
  return values[at];
}

void NvdbGrid::decode_block(const GridBlock& block, std::span<float, 512> values) const {
  if (block.leaf != nullptr) return decode_leaf(block.leaf, values);
  if (block.stream.data != nullptr) return packed_->decode(block.stream, values);
  std::ranges::fill(values, block.value);
}

unsigned NvdbGrid::leaf_bits(const std::byte* leaf) const {
  if (type_ == GridType::float32) return 32;
  if (type_ == GridType::fpn && fpn_bits_log2(leaf) > kMaxLeafBitsLog2) {
    const NvdbBytes bytes(file_, 0, path_);
    bytes.fail(static_cast<std::uint64_t>(leaf - file_.data()) + nvdb::leaf::kFlags, "log2 of the FpN leaf's width is ",
               fpn_bits_log2(leaf), ", at most ", kMaxLeafBitsLog2);
  }
  return 1U << leaf_bits_log2(type_, leaf);
}

void NvdbGrid::decode_leaf(const std::byte* leaf, std::span<float, 512> values) const {
  if (leaf_bits(leaf) == 32) {
    __builtin_memcpy(values.data(), leaf + nvdb::leaf::kValues, values.size_bytes());
    return;
  }
  const unsigned bits_log2 = leaf_bits_log2(type_, leaf);
  const auto quantum = load<float>(leaf + nvdb::leaf::kQuantum);
  const auto minimum = load<float>(leaf + nvdb::leaf::kQuantMinimum);
  for (unsigned i = 0; i < values.size(); ++i) {
    values[i] = dequantize(leaf_code(leaf + nvdb::leaf::kCodes, bits_log2, i), quantum, minimum);
  }
}

void NvdbGrid::for_each_root_entry(const std::function<void(const RootEntry&)>& visit) const {
  const std::byte* grid = data().data();
  for (std::uint32_t t = 0; t < root_tiles_; ++t) {
    const std::byte* tile = grid + nvdb::kRootTilesOffset + t * nvdb::kRootTileBytes;
    const auto child = load<std::int64_t>(tile + nvdb::root::kTileChild);
    visit({root_tile_origin(load<std::uint64_t>(tile + nvdb::root::kTileKey)),
           child != 0 ? grid + nvdb::kRootOffset + child : nullptr,
           load<std::uint32_t>(tile + nvdb::root::kTileState) != 0, load<float>(tile + nvdb::root::kTileValue)});
  }
}

void NvdbGrid::for_each_block(const std::function<void(const GridBlock&)>& visit) const {
  if (packed_) return for_each_packed_block(*packed_, visit);
  for_each_tree_block(visit);
}

void NvdbGrid::for_each_tree_block(const std::function<void(const GridBlock&)>& visit) const {
  for_each_root_entry([&](const RootEntry& entry) {
    if (entry.upper != nullptr) {
      visit_upper(entry.origin, entry.upper, visit);
    } else {
      visit({entry.origin, kUpperDim, entry.active, entry.value, nullptr});
    }
  });
}

void NvdbGrid::visit_upper(const Index3& origin, const std::byte* upper,
                           const std::function<void(const GridBlock&)>& visit) {
  for (unsigned u = 0; u < nvdb::kUpper.entries; ++u) {
    const Index3 at = origin + entry_offset(u, kLowerDim, kUpperLowers);
    if (!mask_on(upper + nvdb::kUpper.child_mask, u)) {
      visit(internal_tile(upper, nvdb::kUpper, u, at, kLowerDim));
      continue;
    }
    const std::byte* lower = child_of(upper, nvdb::kUpper, u);
    for (unsigned l = 0; l < nvdb::kLower.entries; ++l) {
      const Index3 corner = at + entry_offset(l, kLeafDim, kLowerLeaves);
      if (mask_on(lower + nvdb::kLower.child_mask, l)) {
        visit({corner, kLeafDim, true, 0, child_of(lower, nvdb::kLower, l)});
      } else {
        visit(internal_tile(lower, nvdb::kLower, l, corner, kLeafDim));
      }
    }
  }
}

}  // namespace weir
