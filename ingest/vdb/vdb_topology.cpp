#include "ingest/vdb/vdb_topology.h"

#include <bit>
#include <cstddef>
#include <set>
#include <tuple>

namespace weir {
namespace {

constexpr std::uint64_t kLeafMaskBytes = 64;
constexpr std::uint64_t kOriginBytes = 12;
/// The most root entries. Each entry is a block of 4096^3 voxels. No real grid has nearly as many, and they fit in
/// memory.
constexpr std::uint64_t kMaxRootEntries = std::uint64_t{1} << 18U;

/// A bit for each entry of a node of Side^3, z fastest.
template <std::size_t Side>
struct NodeMask {
  static constexpr std::size_t kSide = Side;
  static constexpr std::size_t kBits = Side * Side * Side;
  std::array<std::uint64_t, kBits / 64> words;

  std::uint64_t count() const {
    std::uint64_t bits = 0;
    for (const std::uint64_t word : words) bits += static_cast<std::uint64_t>(std::popcount(word));
    return bits;
  }
  /// Calls `visit` with the offset of each set bit, in rising order.
  template <typename Visit>
  void for_each(const Visit& visit) const {
    for (std::size_t w = 0; w < words.size(); ++w) {
      for (std::uint64_t word = words[w]; word != 0; word &= word - 1) {
        visit(64 * w + static_cast<std::size_t>(std::countr_zero(word)));
      }
    }
  }
  static Index3 position(std::size_t offset) {
    return {static_cast<std::int64_t>(offset / (Side * Side)), static_cast<std::int64_t>(offset / Side % Side),
            static_cast<std::int64_t>(offset % Side)};
  }
};

using UpperMask = NodeMask<32>;
using LowerMask = NodeMask<16>;
using LeafMask = NodeMask<8>;
static_assert(sizeof(LeafMask) == kLeafMaskBytes);

class TreeWalk {
 public:
  TreeWalk(VdbReader& reader, const VdbGrid& grid, const VdbType& type)
      : reader_(reader),
        grid_(grid),
        type_(type),
        stored_bytes_(grid.half && type.real ? 2 * static_cast<std::uint64_t>(type.components) : type.bytes) {}

  VdbTopology run() {
    reader_.seek(grid_.tree_offset);
    if (const auto buffers = reader_.get<std::int32_t>(); buffers != 1) {
      reader_.fail("a tree of ", buffers, " buffers, and 1 can be read; write the file again with OpenVDB 10");
    }
    root();
    for (std::uint64_t leaf = 0; leaf < topology_.nodes[0]; ++leaf) leaf_values();
    return topology_;
  }

 private:
  void root() {
    background();
    const auto tiles = reader_.get<std::uint32_t>();
    const auto children = reader_.get<std::uint32_t>();
    topology_.root_entries = std::uint64_t{tiles} + children;
    if (topology_.root_entries > kMaxRootEntries) {
      reader_.fail("a root of ", topology_.root_entries, " entries, at most ", kMaxRootEntries, " can be read");
    }
    for (std::uint32_t i = 0; i < tiles; ++i) {
      const Index3 origin = root_origin();
      reader_.skip(type_.bytes);
      const auto active = reader_.get<std::uint8_t>();
      if (active > 1) reader_.fail("the state of a root tile is ", unsigned{active}, ", neither 0 nor 1");
      if (active == 1) add_active(origin, kUpperDim);
    }
    for (std::uint32_t i = 0; i < children; ++i) internal<UpperMask>(root_origin());
  }

  void background() {
    if (!type_.real || type_.components > 1) return reader_.skip(type_.bytes);
    topology_.background =
        type_.bytes == sizeof(double) ? reader_.get<double>() : static_cast<double>(reader_.get<float>());
  }

  Index3 root_origin() {
    const auto x = reader_.get<std::int32_t>();
    const auto y = reader_.get<std::int32_t>();
    const auto z = reader_.get<std::int32_t>();
    const Index3 origin{x, y, z};
    if (floor_div(origin, kUpperDim) * kUpperDim != origin || !origins_.emplace(x, y, z).second) {
      reader_.fail("an entry of the root at ", x, ',', y, ',', z, ", which is no multiple of ", kUpperDim,
                   " or there twice");
    }
    return origin;
  }

  template <typename NodeMask>
  void internal(const Index3& origin) {
    constexpr bool kIsUpper = NodeMask::kSide == UpperMask::kSide;
    constexpr std::int64_t kChildDim = kIsUpper ? kLowerDim : kLeafDim;
    ++topology_.nodes[kIsUpper ? 2 : 1];
    const auto children = reader_.get<NodeMask>();
    const auto active = reader_.get<NodeMask>();
    for (std::size_t w = 0; w < active.words.size(); ++w) {
      if ((children.words[w] & active.words[w]) != 0) {
        reader_.fail("an entry of the node at ", origin.x, ',', origin.y, ',', origin.z, " is both tile and child");
      }
    }
    values(active);
    active.for_each([&](std::size_t i) { add_active(origin + NodeMask::position(i) * kChildDim, kChildDim); });
    children.for_each([&](std::size_t i) {
      const Index3 child = origin + NodeMask::position(i) * kChildDim;
      if constexpr (kIsUpper) {
        internal<LowerMask>(child);
      } else {
        leaf(child);
      }
    });
  }

  void leaf(const Index3& origin) {
    ++topology_.nodes[0];
    const auto active = reader_.get<LeafMask>();
    if (topology_.active.contains(Box{origin, origin + Index3{kLeafDim, kLeafDim, kLeafDim}})) return;
    active.for_each([&](std::size_t i) { add_active(origin + LeafMask::position(i), 1); });
  }

  void leaf_values() {
    const auto active = reader_.get<LeafMask>();
    switch (type_.leaf) {
      case VdbLeaf::values:
        return values(active);
      case VdbLeaf::boolean:
        return reader_.skip(kOriginBytes + kLeafMaskBytes);
      case VdbLeaf::mask:
        return reader_.skip(kOriginBytes);
    }
  }

  // Compression.h, readCompressedValues: a byte says how to restore the inactive values. Then come up to two inactive
  // values, a mask that selects between them, and the remaining values.
  template <typename NodeMask>
  void values(const NodeMask& active) {
    enum : std::uint8_t { one_inactive = 2, mask_only = 3, mask_and_one = 4, mask_and_two = 5, all_values = 6 };
    const auto kind = reader_.get<std::uint8_t>();
    if (kind > all_values) reader_.fail("values of kind ", unsigned{kind}, ", at most ", unsigned{all_values});
    if (kind == one_inactive || kind == mask_and_one || kind == mask_and_two) reader_.skip(type_.bytes);
    if (kind == mask_and_two) reader_.skip(type_.bytes);
    if (kind == mask_only || kind == mask_and_one || kind == mask_and_two) reader_.skip(sizeof(NodeMask));
    const bool only_active = (grid_.compression & kVdbActiveMask) != 0 && kind != all_values;
    const std::uint64_t count = only_active ? active.count() : NodeMask::kBits;
    if (count == 0 && grid_.half && type_.real) return;  // not even a length
    packed(count * stored_bytes_);
  }

  // Compression.h, readData: plain bytes, or a length and as many compressed bytes. If the length is not positive,
  // its magnitude in uncompressed bytes follows; OpenVDB reads them before it compares sizes.
  void packed(std::uint64_t bytes) {
    if ((grid_.compression & (kVdbZip | kVdbBlosc)) == 0) return reader_.skip(bytes);
    const auto length = reader_.get<std::int64_t>();
    if (length <= 0) {
      if (std::uint64_t{0} - static_cast<std::uint64_t>(length) != bytes) {
        reader_.fail(bytes, " bytes of values are stored in ", length, "; the file is damaged");
      }
      return reader_.skip(bytes);
    }
    constexpr std::uint64_t kOverhead = 1024;  // more than zlib and blosc add to what they cannot compress
    const auto stored = static_cast<std::uint64_t>(length);
    if (stored > 2 * bytes + kOverhead) {
      reader_.fail(bytes, " bytes of values are compressed to ", length, "; the file is damaged");
    }
    if ((grid_.compression & kVdbBlosc) == 0) return reader_.skip(stored);
    // Blosc trusts the length in its own header: README_CHUNK_FORMAT, "cbytes".
    struct BloscHeader {
      std::array<std::uint32_t, 3> versions_and_sizes;
      std::uint32_t compressed_bytes;
    };
    if (stored < sizeof(BloscHeader)) reader_.fail("a blosc chunk of ", stored, " bytes, shorter than its header");
    if (const auto chunk = reader_.get<BloscHeader>(); chunk.compressed_bytes != stored) {
      reader_.fail("a blosc chunk of ", chunk.compressed_bytes, " bytes stored in ", stored, "; the file is damaged");
    }
    reader_.skip(stored - sizeof(BloscHeader));
  }

  void add_active(const Index3& origin, std::int64_t dim) {
    const Box box{origin, origin + Index3{dim, dim, dim}};
    Box& all = topology_.active;
    all = all.empty() ? box : Box{min(all.lo, box.lo), max(all.hi, box.hi)};
  }

  VdbReader& reader_;
  const VdbGrid& grid_;
  const VdbType& type_;
  std::uint64_t stored_bytes_;  ///< of a value in a run
  VdbTopology topology_;
  std::set<std::tuple<std::int32_t, std::int32_t, std::int32_t>> origins_;
};

}  // namespace

VdbTopology walk_vdb_tree(VdbReader& reader, const VdbGrid& grid, const VdbType& type) {
  return TreeWalk(reader, grid, type).run();
}

}  // namespace weir
