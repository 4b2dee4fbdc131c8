#include "compressor/levels/smallest_tree.h"

#include <vector>

#include "compressor/select/fixed_bytes.h"
#include "compressor/select/leaf_choice.h"
#include "compressor/select/leaf_gain.h"
#include "compressor/select/tree_regions.h"
#include "format/layout/tree_layout.h"
#include "format/nanovdb/macrocells.h"

namespace weir {
namespace {

constexpr std::uint64_t kOneValueBlockBytes = 8;  // of a packed block's stream of one value, and where it ends; 7

std::uint64_t bytes_of_required_leaf(const ConversionOptions& options) {
  Encoding smallest = options.encoding == Encoding::automatic ? Encoding::fpn : options.encoding;
  if (smallest == Encoding::fpn && options.metric != Metric::sse) smallest = Encoding::float32;
  return leaf_bytes(widths_of(smallest).front());
}

// The voxels with a value of each leaf of a region, and what follows.
struct RegionNeed {
  std::uint64_t valued = 0;
  std::uint64_t leaves = 0;  // leaves that are always kept
};

RegionNeed need_of(const VolumeSource& source, const TreeRegions& tree, std::int64_t region, const Fill& fill) {
  const Box leaves = tree.leaf_box(region);
  std::vector<std::uint64_t> valued(static_cast<std::size_t>(leaves.voxels()));
  for (const Box& box : source.voxels_with_values(tree.leaves.voxels(leaves))) {
    const NodeLattice touched = make_lattice(box, kLeafDim);
    for_each_index({{0, 0, 0}, touched.count}, [&](const Index3& i) {
      const Index3 leaf = touched.first + i - tree.leaves.first;
      valued[static_cast<std::size_t>(linear_index(leaf - leaves.lo, leaves.extent()))] +=
          static_cast<std::uint64_t>(touched.voxels(i).voxels());
    });
  }
  RegionNeed need;
  for_each_index(leaves, [&](const Index3& leaf) {
    const std::uint64_t of_leaf = valued[static_cast<std::size_t>(linear_index(leaf - leaves.lo, leaves.extent()))];
    need.valued += of_leaf;
    need.leaves += is_corner(tree.leaves, leaf) || fill.splits(of_leaf, kLeafVoxels) ? 1 : 0;
  });
  return need;
}

}  // namespace

std::uint64_t smallest_tree(const VolumeSource& source, const ConversionOptions& options) {
  const Box domain = source.info().domain();
  if (options.encoding == Encoding::packed) {
    const bool preview = options.preview == Preview::on;  // a preview contains the corners' regions
    return fixed_bytes(domain, Encoding::packed, preview ? Preview::on : Preview::off, 0, preview ? 1 : 0);
  }
  const TreeRegions tree(domain);
  Fill fill;
  fill.gaps = source.info().mapping.gaps;
  struct UpperNeed {
    std::uint64_t valued = 0;
    bool open = false;
  };
  std::vector<UpperNeed> uppers(tree.uppers.size());
  NodeCounts counts;
  counts.root_tiles = tree.uppers.size();
  counts.macrocells = static_cast<std::uint64_t>(make_lattice(domain, kMacrocell).size());
  for (std::int64_t region = 0; region < std::ssize(tree.regions); ++region) {
    const RegionNeed need = need_of(source, tree, region, fill);
    UpperNeed& upper = uppers[static_cast<std::size_t>(tree.upper_of(region))];
    upper.valued += need.valued;
    counts.leaves += need.leaves;
    if (need.leaves == 0 && !fill.splits(need.valued, kLowerDim * kLowerDim * kLowerDim)) continue;
    ++counts.lowers;
    upper.open = true;
  }
  for (const UpperNeed& upper : uppers) {
    if (upper.open || fill.splits(upper.valued, kUpperDim * kUpperDim * kUpperDim)) ++counts.uppers;
  }
  counts.leaf_bytes = counts.leaves * bytes_of_required_leaf(options);
  return make_layout(counts).file_bytes;
}

std::uint64_t room_for_packed(const Box& domain) {
  const auto blocks = static_cast<std::uint64_t>(make_lattice(domain, kLeafDim).size());
  return fixed_bytes(domain, Encoding::packed, Preview::off, 0, region_count(domain)) + kOneValueBlockBytes * blocks;
}

}  // namespace weir
