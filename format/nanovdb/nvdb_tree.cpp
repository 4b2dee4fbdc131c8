#include "format/nanovdb/nvdb_tree.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <utility>
#include <vector>

#include "format/layout/nanovdb_layout.h"

namespace weir {
namespace {

using nvdb::InternalLayout;

constexpr std::uint64_t kMaxLeafBytes = nvdb::kLeafHeadBytes + (std::uint64_t{64} << kMaxLeafBitsLog2);
constexpr std::uint64_t kMinFpnLeafBytes = nvdb::kLeafHeadBytes + 64;
constexpr std::uint64_t kNodesToRelease = 256;                      // lower nodes, of 34 KB each
constexpr std::uint64_t kKeyField = (std::uint64_t{1} << 20U) - 1;  // 20 bits of a coordinate, in fields of 21
constexpr std::uint64_t kKeyBits = kKeyField | kKeyField << 21U | kKeyField << 42U;

// An array of the nodes of one level; `stride` is 0 if sizes vary.
struct Level {
  const char* name;
  std::uint64_t begin;
  std::uint64_t count;
  std::uint64_t stride;

  std::uint64_t end() const { return begin + count * stride; }
};

class TreeReader {
 public:
  TreeReader(const NvdbBytes& grid, GridType type, std::function<void()> release)
      : grid_(grid), type_(type), release_(std::move(release)) {}

  NvdbTree read() {
    read_head();
    upper_seen_.resize(upper_.count);
    lower_seen_.resize(lower_.count);
    read_root_table([this](std::uint64_t entry, std::int64_t child) {
      visit_once(upper_, upper_seen_, entry, child_offset(entry, nvdb::kRootOffset, child));
    });
    check_reached(upper_, upper_seen_);
    for (std::uint64_t i = 0; i < upper_.count; ++i) {
      for_each_child(nvdb::kUpper, upper_.begin + i * upper_.stride, [this](std::uint64_t entry, std::uint64_t child) {
        visit_once(lower_, lower_seen_, entry, child);
      });
    }
    check_reached(lower_, lower_seen_);
    read_leaves();
    read_bbox();
    return tree_;
  }

  NvdbTree read_head_alone() {
    read_head();
    read_root_table([](std::uint64_t, std::int64_t) {});
    read_bbox();
    return tree_;
  }

 private:
  void read_head() {
    for (std::size_t level = 0; level < 3; ++level) {
      tree_.node_counts[level] = tree_field<std::uint32_t>(nvdb::tree::kNodeCount + 4 * level);
      tree_.tile_counts[level] = tree_field<std::uint32_t>(nvdb::tree::kTileCount + 4 * level);
    }
    tree_.active_voxels = tree_field<std::uint64_t>(nvdb::tree::kVoxelCount);
    if (const auto root = tree_field<std::uint64_t>(nvdb::tree::kRootOffset); root != nvdb::kTreeBytes) {
      grid_.fail(nvdb::kTreeOffset + nvdb::tree::kRootOffset, "root offset ", root, " instead of ", nvdb::kTreeBytes);
    }
    tree_.root_tiles = grid_.get<std::uint32_t>(nvdb::kRootOffset + nvdb::root::kTableSize);
    tree_.end = nvdb::kRootTilesOffset + tree_.root_tiles * nvdb::kRootTileBytes;
    if (tree_.end > grid_.size()) {
      grid_.fail(nvdb::kRootOffset + nvdb::root::kTableSize, "a root table of ", tree_.root_tiles,
                 " entries reaches beyond the grid's ", grid_.size(), " bytes");
    }
    upper_ = read_level("upper", nvdb::tree::kUpperOffset, tree_.node_counts[2], nvdb::kUpperBytes);
    lower_ = read_level("lower", nvdb::tree::kLowerOffset, tree_.node_counts[1], nvdb::kLowerBytes);
    leaf_ = read_level("leaf", nvdb::tree::kLeafOffset, tree_.node_counts[0], fixed_leaf_bytes(type_));
  }

  // The stored offset of a level without nodes has no meaning.
  Level read_level(const char* name, std::uint64_t field, std::uint32_t count, std::uint64_t stride) {
    if (count == 0) return {name, tree_.end, 0, stride};
    const auto offset = tree_field<std::uint64_t>(field);
    std::uint64_t begin = 0;
    if (__builtin_add_overflow(offset, nvdb::kTreeOffset, &begin) || begin < tree_.end || begin > grid_.size() ||
        begin % nvdb::kAlignment != 0) {
      grid_.fail(nvdb::kTreeOffset + field, "first ", name, " node at offset ", offset,
                 ", not a multiple of 32 behind the level above and inside the grid's ", grid_.size(), " bytes");
    }
    const Level level{name, begin, count, stride};
    if (level.end() > grid_.size()) {
      grid_.fail(nvdb::kTreeOffset + field, count, " ", name, " nodes at offset ", offset, " reach beyond the grid's ",
                 grid_.size(), " bytes");
    }
    tree_.end = level.end();
    return level;
  }

  // Calls visit(offset of the table entry, the entry's child offset) for every child.
  template <typename Visit>
  void read_root_table(const Visit& visit) {
    std::vector<std::uint64_t> keys(tree_.root_tiles);
    for (std::uint32_t i = 0; i < tree_.root_tiles; ++i) {
      const std::uint64_t tile = nvdb::kRootTilesOffset + i * nvdb::kRootTileBytes;
      const auto key = grid_.get<std::uint64_t>(tile + nvdb::root::kTileKey);
      if ((key & ~kKeyBits) != 0) grid_.fail(tile, "root tile key 0x", hex(key), " is no key of 32-bit coordinates");
      keys[i] = key;
      const Index3 origin = root_tile_origin(key);
      const Box box{origin, origin + Index3{kUpperDim, kUpperDim, kUpperDim}};
      root_box_ = i == 0 ? box : Box{min(root_box_.lo, box.lo), max(root_box_.hi, box.hi)};
      const auto child = grid_.get<std::int64_t>(tile + nvdb::root::kTileChild);
      if (child != 0) visit(tile + nvdb::root::kTileChild, child);
    }
    std::sort(keys.begin(), keys.end());
    if (const auto twice = std::adjacent_find(keys.begin(), keys.end()); twice != keys.end()) {
      grid_.fail(nvdb::kRootTilesOffset, "root tile key 0x", hex(*twice), " stands in the table twice");
    }
  }

  // Calls visit(offset of the table entry, offset of the child) for every child of an internal node.
  template <typename Visit>
  void for_each_child(const InternalLayout& layout, std::uint64_t node, const Visit& visit) const {
    for (std::uint64_t word = 0; word < layout.entries / 64; ++word) {
      auto children = grid_.get<std::uint64_t>(node + layout.child_mask + 8 * word);
      if (const auto both = children & grid_.get<std::uint64_t>(node + layout.value_mask + 8 * word); both != 0) {
        grid_.fail(node + layout.child_mask + 8 * word, "entry ",
                   64 * word + static_cast<unsigned>(std::countr_zero(both)), " is both a value and a child");
      }
      for (; children != 0; children &= children - 1) {
        const std::uint64_t n = 64 * word + static_cast<unsigned>(std::countr_zero(children));
        const std::uint64_t entry = node + layout.table + 8 * n;
        visit(entry, child_offset(entry, node, grid_.get<std::int64_t>(entry)));
      }
    }
  }

  // `entry` and `node` are inside a file, so only the sum with an arbitrary `child` can leave it.
  std::uint64_t child_offset(std::uint64_t entry, std::uint64_t node, std::int64_t child) const {
    std::int64_t offset = 0;
    if (__builtin_add_overflow(static_cast<std::int64_t>(node), child, &offset) || offset < 0) {
      grid_.fail(entry, "child offset ", child, " leaves the grid");
    }
    return static_cast<std::uint64_t>(offset);
  }

  void visit_once(const Level& level, std::vector<bool>& seen, std::uint64_t entry, std::uint64_t child) {
    if (child < level.begin || child >= level.end() || (child - level.begin) % level.stride != 0) {
      fail_child(level, entry, child);
    }
    const std::uint64_t i = (child - level.begin) / level.stride;
    if (seen[i]) grid_.fail(entry, level.name, " node ", i, " at grid offset ", child, " has two parents");
    seen[i] = true;
  }

  void check_reached(const Level& level, const std::vector<bool>& seen) const {
    const auto lost = std::find(seen.begin(), seen.end(), false);
    if (lost != seen.end()) {
      const auto i = static_cast<std::uint64_t>(lost - seen.begin());
      grid_.fail(level.begin + i * level.stride, level.name, " node ", i, " of ", level.count, " has no parent");
    }
  }

  [[noreturn]] void fail_child(const Level& level, std::uint64_t entry, std::uint64_t child) const {
    grid_.fail(entry, "a child at grid offset ", child, " is none of the ", level.count, " ", level.name,
               " nodes from grid offset ", level.begin);
  }

  // One pass checks the offsets and finds the last leaf. If sizes vary, only leaves that begin less than the largest
  // leaf before the end can reach beyond it: a second pass reads their widths.
  void read_leaves() {
    const std::uint64_t smallest = leaf_.stride != 0 ? leaf_.stride : kMinFpnLeafBytes;
    const std::uint64_t stride = leaf_.stride != 0 ? leaf_.stride : nvdb::kAlignment;
    const std::uint64_t stop = leaf_.stride != 0 ? leaf_.end() : grid_.size();
    std::uint64_t entries = 0;
    std::uint64_t last = 0;
    for_each_leaf([&](std::uint64_t entry, std::uint64_t child) {
      if (child < leaf_.begin || child > stop || stop - child < smallest || (child - leaf_.begin) % stride != 0) {
        fail_child(leaf_, entry, child);
      }
      ++entries;
      last = std::max(last, child);
    });
    if (entries != leaf_.count) {
      grid_.fail(nvdb::kTreeOffset + nvdb::tree::kNodeCount, leaf_.count, " leaves, but the lower nodes have ",
                 entries);
    }
    if (leaf_.stride != 0 || entries == 0) return;
    tree_.end = fpn_leaf_end(last);
    for_each_leaf([&](std::uint64_t, std::uint64_t child) {
      if (child + kMaxLeafBytes > tree_.end) tree_.end = std::max(tree_.end, fpn_leaf_end(child));
    });
  }

  template <typename Visit>
  void for_each_leaf(const Visit& visit) const {
    for (std::uint64_t i = 0; i < lower_.count; ++i) {
      for_each_child(nvdb::kLower, lower_.begin + i * lower_.stride, visit);
      if (release_ && (i + 1) % kNodesToRelease == 0) release_();
    }
  }

  std::uint64_t fpn_leaf_end(std::uint64_t leaf) const {
    const unsigned log2 = fpn_bits_log2(grid_.at(leaf));
    if (log2 > kMaxLeafBitsLog2) {
      grid_.fail(leaf + nvdb::leaf::kFlags, "log2 of the FpN leaf's width is ", log2, ", at most ", kMaxLeafBitsLog2);
    }
    if (!grid_.holds(leaf, quantised_leaf_bytes(log2))) {
      grid_.fail(leaf, "an FpN leaf of ", quantised_leaf_bytes(log2), " bytes reaches beyond the grid's ", grid_.size(),
                 " bytes");
    }
    return leaf + quantised_leaf_bytes(log2);
  }

  void read_bbox() {
    const auto corner = [this](std::uint64_t field) {
      return Index3{grid_.get<std::int32_t>(nvdb::kRootOffset + field),
                    grid_.get<std::int32_t>(nvdb::kRootOffset + field + 4),
                    grid_.get<std::int32_t>(nvdb::kRootOffset + field + 8)};
    };
    const Box box{corner(nvdb::root::kBBox), corner(nvdb::root::kBBox + 12) + Index3{1, 1, 1}};
    if (box.empty()) return;
    const Index3 extent = box.extent();
    std::int64_t voxels = 0;
    const bool huge = __builtin_mul_overflow(extent.x, extent.y, &voxels) ||
                      __builtin_mul_overflow(voxels, extent.z, &voxels) || voxels >= std::int64_t{1} << 62U;
    if (huge || tree_.root_tiles == 0 || !root_box_.contains(box)) {
      grid_.fail(nvdb::kRootOffset, "bounding box [", box.lo.x, ",", box.lo.y, ",", box.lo.z, "] .. [", box.hi.x, ",",
                 box.hi.y, ",", box.hi.z, ") lies outside the ", tree_.root_tiles,
                 " root tiles or has 2^62 voxels or more");
    }
    tree_.bbox = box;
  }

  template <typename T>
  T tree_field(std::uint64_t field) const {
    return grid_.get<T>(nvdb::kTreeOffset + field);
  }

  const NvdbBytes& grid_;
  GridType type_;
  std::function<void()> release_;
  NvdbTree tree_;
  Level upper_{};
  Level lower_{};
  Level leaf_{};
  std::vector<bool> upper_seen_;
  std::vector<bool> lower_seen_;
  Box root_box_;
};

}  // namespace

std::uint64_t fixed_leaf_bytes(GridType type) {
  switch (type) {
    case GridType::float32:
      return nvdb::kFloatLeafBytes;
    case GridType::fp4:
      return quantised_leaf_bytes(2);
    case GridType::fp8:
      return quantised_leaf_bytes(3);
    case GridType::fp16:
      return quantised_leaf_bytes(4);
    case GridType::fpn:
      return 0;
  }
  return 0;
}

Index3 root_tile_origin(std::uint64_t key) {
  const auto axis = [key](unsigned shift) {
    const auto field = static_cast<std::uint32_t>(key >> shift & kKeyField);
    return static_cast<std::int64_t>(static_cast<std::int32_t>(field << 12U));
  };
  return {axis(42), axis(21), axis(0)};
}

NvdbTree read_nvdb_tree(const NvdbBytes& grid, GridType type, const std::function<void()>& release) {
  return TreeReader(grid, type, release).read();
}

NvdbTree read_nvdb_tree_head(const NvdbBytes& grid, GridType type) {
  return TreeReader(grid, type, {}).read_head_alone();
}

}  // namespace weir
