#include "format/nanovdb/expanded_tree.h"

#include <algorithm>
#include <cmath>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/nanovdb/node_image.h"
#include "format/nanovdb/packed_blocks.h"
#include "format/packed/packed_layout.h"

namespace weir {
namespace {

constexpr unsigned kLowerBlocks = packed::chunk::kGroupCount * packed::chunk::kGroupBlocks;

Box cube(const Index3& lo, std::int64_t dim) { return {lo, lo + Index3{dim, dim, dim}}; }

}  // namespace

std::uint64_t ExpandedTree::leaf_bytes(GridType type) {
  return type == GridType::float32 ? nvdb::kFloatLeafBytes : nvdb::kLeafHeadBytes + 2 * kLeafVoxels;
}

ExpandedTree::ExpandedTree(const NvdbGrid& grid, GridType type)
    : grid_(grid), packed_(*grid.packed()), type_(type), domain_(grid.index_bbox()) {
  const NodeLattice roots = make_lattice(domain_, kUpperDim);
  // Sorted by x, y and z, like the root's table.
  for (std::int64_t x = 0; x < roots.count.x; ++x) {
    for (std::int64_t y = 0; y < roots.count.y; ++y) {
      for (std::int64_t z = 0; z < roots.count.z; ++z) {
        uppers_.push_back({roots.node_box({x, y, z}).lo, lowers_.size()});
        for_each_entry(uppers_.back(), [&](const Index3&, std::int64_t region, bool has_node) {
          if (has_node) add_lower(region);
        });
      }
    }
  }
  NodeCounts counts;
  counts.root_tiles = uppers_.size();
  counts.uppers = uppers_.size();
  counts.lowers = lowers_.size();
  counts.leaves = blocks_.size();
  counts.leaf_bytes = blocks_.size() * leaf_bytes(type_);
  counts.macrocells = grid_.macrocells().cells.size();
  check_countable(counts, packed_.path());
  layout_ = make_layout(counts);
}

// Calls visit(entry, linear index of its region, whether it has a lower node) for each entry that has voxels of the
// domain, in the order of the table.
template <class Visit>
void ExpandedTree::for_each_entry(const Upper& upper, const Visit& visit) const {
  const NodeLattice& regions = packed_.regions();
  const Index3 first = floor_div(upper.origin, kLowerDim) - regions.first;
  const Box inside = intersect(cube(first, kUpperLowers), {{0, 0, 0}, regions.count});
  for (std::int64_t x = inside.lo.x; x < inside.hi.x; ++x) {
    for (std::int64_t y = inside.lo.y; y < inside.hi.y; ++y) {
      for (std::int64_t z = inside.lo.z; z < inside.hi.z; ++z) {
        const Index3 at{x, y, z};
        visit(at - first, regions.linear(at), packed_.region(at).chunk != 0 || regions.overhangs(at));
      }
    }
  }
}

void ExpandedTree::add_lower(std::int64_t region) {
  lowers_.push_back({region, blocks_.size()});
  const Index3 at = packed_.regions().position(region);
  const Index3 corner = packed_.regions().node_box(at).lo;
  const auto add = [&](unsigned position, bool coded) {
    const Box block = cube(corner + packed_block(position) * kLeafDim, kLeafDim);
    if (intersect(block, domain_).empty() || (!coded && domain_.contains(block))) return;
    blocks_.push_back(static_cast<std::uint64_t>(region) * kLowerBlocks + position);
  };
  if (const PackedRegion packed = packed_.region(at); packed.chunk != 0) {
    packed_.for_each_stream(
        packed, [&](unsigned position, const PackedStream& stream) { add(position, stream.data != nullptr); });
  } else {
    for (unsigned position = 0; position < kLowerBlocks; ++position) add(position, false);
  }
}

NodeStatistics ExpandedTree::write_lower(std::uint64_t i, std::span<const LeafStatistics> leaves, const Sink& sink,
                                         std::uint64_t& tiles) const {
  const Lower& lower = lowers_[i];
  const Index3 at = packed_.regions().position(lower.region);
  const Index3 corner = packed_.regions().node_box(at).lo;
  const float value = packed_.region(at).value;
  const std::uint64_t offset = layout_.lower_offset(i);
  NodeImage image(NodeImage::Level::lower, grid_.background());
  NodeStatistics total;
  std::uint64_t leaf = lower.first;
  for (unsigned position = 0; position < kLowerBlocks; ++position) {
    const Index3 entry = packed_block(position);
    const Box block = cube(corner + entry * kLeafDim, kLeafDim);
    const Box inside = intersect(block, domain_);
    if (inside.empty()) continue;
    if (leaf < blocks_.size() && blocks_[leaf] == static_cast<std::uint64_t>(lower.region) * kLowerBlocks + position) {
      image.set_child(entry, layout_.leaves + leaf * leaf_bytes(type_) - offset);
      NodeStatistics child;
      child.min = std::min(child.min, leaves[leaf].min);
      child.max = std::max(child.max, leaves[leaf].max);
      child.mean = leaves[leaf].mean;
      child.m2 = leaves[leaf].m2;
      child.count = static_cast<std::uint64_t>(inside.voxels());
      child.bbox = inside;
      total.add(child);
      ++leaf;
    } else {
      image.set_tile(entry, value, true);
      total.add_tile(value, static_cast<std::uint64_t>(block.voxels()), block);
      ++tiles;
    }
  }
  image.set_statistics(total);
  sink(offset - layout_.grid, image.bytes());
  return total;
}

NodeStatistics ExpandedTree::write_upper(std::uint64_t i, std::span<const NodeStatistics> lowers, const Sink& sink,
                                         std::uint64_t& tiles) const {
  const Upper& upper = uppers_[i];
  const std::uint64_t offset = layout_.upper_offset(i);
  NodeImage image(NodeImage::Level::upper, grid_.background());
  NodeStatistics total;
  std::uint64_t lower = upper.first;
  for_each_entry(upper, [&](const Index3& entry, std::int64_t region, bool has_node) {
    if (has_node) {
      image.set_child(entry, layout_.lower_offset(lower) - offset);
      total.add(lowers[lower]);
      ++lower;
      return;
    }
    const Index3 at = packed_.regions().position(region);
    const Box box = packed_.regions().node_box(at);
    const float value = packed_.region(at).value;
    image.set_tile(entry, value, true);
    total.add_tile(value, static_cast<std::uint64_t>(box.voxels()), box);
    ++tiles;
  });
  image.set_statistics(total);
  sink(offset - layout_.grid, image.bytes());
  return total;
}

void ExpandedTree::write(std::span<const LeafStatistics> leaves, const Sink& sink) const {
  const auto fits = [](const LeafStatistics& s) { return std::isfinite(s.mean) && std::isfinite(s.max - s.min); };
  if (type_ == GridType::fp16 && !std::ranges::all_of(leaves, fits)) {
    throw Error(ErrorKind::input, cat(packed_.path(), ": has values that are not finite, or too far apart, for 16-bit",
                                      " leaves; load it as float"));
  }
  GridHead head;
  std::vector<NodeStatistics> lowers(lowers_.size());
  for (std::uint64_t i = 0; i < lowers_.size(); ++i) lowers[i] = write_lower(i, leaves, sink, head.active_tiles[0]);
  for (std::uint64_t i = 0; i < uppers_.size(); ++i) {
    head.statistics.add(write_upper(i, lowers, sink, head.active_tiles[1]));
    head.tiles.push_back({uppers_[i].origin, layout_.upper_offset(i), false, 0});
  }
  head.type = type_;
  head.grid_class = static_cast<GridClass>(load<std::uint32_t>(grid_.data().data() + nvdb::grid::kGridClass));
  head.name = grid_.name();
  head.voxel_size = grid_.voxel_size();
  head.origin = grid_.world_origin();
  head.background = grid_.background();
  sink(0, std::span<const std::byte>(encode_head(head, layout_)).subspan(layout_.grid));
  sink(layout_.blind_meta - layout_.grid, encode_blind_records(layout_));
  const std::span<const std::byte> macrocells = std::as_bytes(grid_.macrocells().cells);
  sink(layout_.blind_data - layout_.grid, macrocells);
  const std::uint64_t end = layout_.blind_data + macrocells.size();
  sink(end - layout_.grid, std::vector<std::byte>(layout_.file_bytes - end));
}

}  // namespace weir
