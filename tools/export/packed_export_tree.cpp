#include "tools/export/packed_export_tree.h"

#include <algorithm>

#include "format/nanovdb/packed_data.h"

namespace weir {
namespace {

Box box_of_edge(const Index3& origin, std::int64_t dim) { return {origin, origin + Index3{dim, dim, dim}}; }

// Returns the lowest voxel of an entry of a node at `origin`. The node has `side` entries of `dim` voxels along an
// edge.
Index3 entry_origin(const Index3& origin, std::size_t entry, std::int64_t dim, std::int64_t side) {
  const auto e = static_cast<std::int64_t>(entry);
  return origin + Index3{e / (side * side), e / side % side, e % side} * dim;
}

template <typename Mask>
void set_bit(Mask& mask, std::size_t bit) {
  mask[bit / 64] |= std::uint64_t{1} << (bit % 64);
}

class PackedExportTree final : public ExportTree {
 public:
  explicit PackedExportTree(const NvdbGrid& grid)
      : grid_(grid), packed_(*grid.packed()), domain_(packed_.regions().domain) {}

  std::vector<ExportRoot> roots() const override {
    std::vector<ExportRoot> all;
    const NodeLattice lattice = make_lattice(domain_, kUpperDim);
    for_each_index({{0, 0, 0}, lattice.count}, [&](const Index3& i) {
      const Index3 origin = lattice.node_box(i).lo;
      all.push_back({origin, true, {nullptr, origin}, false, 0.0F});
    });
    return all;
  }

  void read_upper(const ExportNode& upper, UpperNode& node) const override {
    clear(node);
    for (std::size_t entry = 0; entry < node.values.size(); ++entry) {
      const Box box = box_of_edge(entry_origin(upper.origin, entry, kLowerDim, kUpperLowers), kLowerDim);
      if (intersect(box, domain_).empty()) continue;
      const PackedRegion region = region_at(box.lo);
      add(node, entry, box, region.chunk != 0, region.value);
    }
  }

  void read_lower(const ExportNode& lower, LowerNode& node) const override {
    clear(node);
    const PackedRegion region = region_at(lower.origin);
    const auto add_block = [&](unsigned position, bool coded) {
      const Box box = box_of_edge(entry_origin(lower.origin, position, kLeafDim, kLowerLeaves), kLeafDim);
      if (!intersect(box, domain_).empty()) add(node, position, box, coded, region.value);
    };
    if (region.chunk == 0) {
      for (unsigned position = 0; position < node.values.size(); ++position) add_block(position, false);
      return;
    }
    // Positions in a region have the order of the entries.
    packed_.for_each_stream(
        region, [&](unsigned position, const PackedStream& stream) { add_block(position, stream.data != nullptr); });
  }

  ExportNode lower_of(const ExportNode& upper, std::size_t entry) const override {
    return {nullptr, entry_origin(upper.origin, entry, kLowerDim, kUpperLowers)};
  }
  ExportNode leaf_of(const ExportNode& lower, std::size_t entry) const override {
    return {nullptr, entry_origin(lower.origin, entry, kLeafDim, kLowerLeaves)};
  }

  NodeMask<kLeafVoxels> leaf_mask(const ExportNode& leaf) const override {
    NodeMask<kLeafVoxels> mask{};
    if (domain_.contains(box_of_edge(leaf.origin, kLeafDim))) {
      mask.fill(~std::uint64_t{0});
      return mask;
    }
    for (std::size_t n = 0; n < kLeafVoxels; ++n) {
      if (domain_.contains(entry_origin(leaf.origin, n, 1, kLeafDim))) set_bit(mask, n);
    }
    return mask;
  }

  void read_leaf(const ExportNode& leaf, std::span<float, 512> values) const override {
    grid_.decode_block(grid_.block_at(leaf.origin), values);
    if (domain_.contains(box_of_edge(leaf.origin, kLeafDim))) return;
    for (std::size_t n = 0; n < values.size(); ++n) {
      if (!domain_.contains(entry_origin(leaf.origin, n, 1, kLeafDim))) values[n] = grid_.background();
    }
  }

  std::uint64_t leaves() const override { return static_cast<std::uint64_t>(make_lattice(domain_, kLeafDim).size()); }

 private:
  template <std::size_t Entries>
  void clear(InternalNode<Entries>& node) const {
    node.children = {};
    node.active = {};
    std::ranges::fill(node.values, grid_.background());
  }

  // Adds a tile if the box lies in the domain and has a single value, otherwise a child.
  template <std::size_t Entries>
  void add(InternalNode<Entries>& node, std::size_t entry, const Box& box, bool coded, float value) const {
    if (coded || !domain_.contains(box)) return set_bit(node.children, entry);
    set_bit(node.active, entry);
    node.values[entry] = value;
  }

  PackedRegion region_at(const Index3& voxel) const {
    return packed_.region(floor_div(voxel, kLowerDim) - packed_.regions().first);
  }

  const NvdbGrid& grid_;
  const PackedData& packed_;
  Box domain_;
};

}  // namespace

std::unique_ptr<ExportTree> make_packed_export_tree(const NvdbGrid& grid) {
  return std::make_unique<PackedExportTree>(grid);
}

}  // namespace weir
