#include "compressor/encode.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "format/leaf_codec.h"

namespace weir {
namespace {

// Regions under a box of leaf-lattice positions, as a box of region-lattice positions.
Box regions_under(const TreeRegions& tree, const Box& leaf_box) {
  const Index3 lo = floor_div(tree.leaves.first + leaf_box.lo, kLowerLeaves) - tree.region_lattice.first;
  const Index3 last =
      floor_div(tree.leaves.first + leaf_box.hi - Index3{1, 1, 1}, kLowerLeaves) - tree.region_lattice.first;
  return {lo, last + Index3{1, 1, 1}};
}

template <typename Visit>
void for_each_in(const Box& box, Visit&& visit) {
  for (std::int64_t z = box.lo.z; z < box.hi.z; ++z) {
    for (std::int64_t y = box.lo.y; y < box.hi.y; ++y) {
      for (std::int64_t x = box.lo.x; x < box.hi.x; ++x) visit(Index3{x, y, z});
    }
  }
}

// The leaf layers and rows of `block` (lattice positions) that hold kept leaves; x is left whole,
// because rows are what a file is read by. Empty where nothing is kept.
Box trim_to_kept(const TreeRegions& tree, const MaskStore& masks, const Box& block) {
  Box kept{block.hi, block.lo};
  for_each_in(regions_under(tree, block), [&](const Index3& at) {
    const std::int64_t region = tree.region_lattice.linear(at);
    if (tree.regions[static_cast<std::size_t>(region)].leaves == 0) return;
    const LeafMask mask = masks.read(region);
    for_each_in(intersect(tree.leaf_box(region), block), [&](const Index3& leaf) {
      if (!mask.test(tree.mask_position(leaf))) return;
      kept.lo = min(kept.lo, leaf);
      kept.hi = max(kept.hi, leaf + Index3{1, 1, 1});
    });
  });
  if (kept.empty()) return kept;
  kept.lo.x = block.lo.x;
  kept.hi.x = block.hi.x;
  return kept;
}

// Encodes the kept leaves of one x layer of one region, which follow each other in the file.
class LayerEncoder {
 public:
  void run(const EncodeTarget& target, const Block& block, const Box& leaf_box, std::int64_t region_index,
           const LeafMask& mask, std::int64_t x) {
    const TreeRegions& tree = target.tree;
    const Region& region = tree.regions[static_cast<std::size_t>(region_index)];
    const Box box = intersect(tree.leaf_box(region_index), leaf_box);
    for (std::int64_t y = box.lo.y; y < box.hi.y; ++y) {
      for (std::int64_t z = box.lo.z; z < box.hi.z; ++z) {
        const Index3 leaf{x, y, z};
        const std::size_t position = tree.mask_position(leaf);
        if (!mask.test(position)) continue;
        const std::uint64_t ordinal = region.first_leaf + mask.count_before(position);
        if (ordinal != first_ + records_.size() + waiting_) {
          flush(target);
          first_ = ordinal;
        }
        encode(target, block, leaf);
      }
    }
    flush(target);
  }

 private:
  // Gathers one leaf; statistics and bytes come when the batch is full.
  void encode(const EncodeTarget& target, const Block& block, const Index3& leaf) {
    const Box node = target.tree.leaves.node_box(leaf);
    const Box inside = target.tree.leaves.voxels(leaf);
    LeafValues& values = values_[waiting_];
    gather_leaf(block.values, block.voxels, node, inside, target.fill.background, values);
    if (target.fill.non_finite != NonFinitePolicy::keep) {
      for (float& v : values) v = std::isfinite(v) ? v : target.fill.background;
    }
    nodes_[waiting_] = node;
    insides_[waiting_] = inside;
    if (++waiting_ == kLeafBatch) encode_waiting();
  }

  void encode_waiting() {
    const std::span<NodeStatistics> statistics(statistics_.data(), waiting_);
    full_leaf_statistics({values_.data(), waiting_}, {nodes_.data(), waiting_}, statistics);
    for (std::size_t i = 0; i < waiting_; ++i) {
      if (insides_[i] != nodes_[i]) statistics[i] = leaf_statistics(values_[i], nodes_[i], insides_[i]);
      const std::size_t at = bytes_.size();
      bytes_.resize(at + nvdb::kFloatLeafBytes);
      encode_float_leaf(values_[i], nodes_[i], insides_[i], statistics[i],
                        std::span<std::byte, nvdb::kFloatLeafBytes>(bytes_.data() + at, nvdb::kFloatLeafBytes));
      records_.push_back(make_leaf_record(values_[i], nodes_[i], insides_[i], statistics[i]));
    }
    waiting_ = 0;
  }

  void flush(const EncodeTarget& target) {
    encode_waiting();
    if (records_.empty()) return;
    target.out.write_at(target.layout.leaves + first_ * nvdb::kFloatLeafBytes, bytes_);
    target.records.write(first_, records_);
    bytes_.clear();
    records_.clear();
  }

  std::uint64_t first_ = 0;  // ordinal of the first leaf not yet written
  std::size_t waiting_ = 0;  // leaves gathered and not yet encoded
  std::array<LeafValues, kLeafBatch> values_{};
  std::array<Box, kLeafBatch> nodes_{};
  std::array<Box, kLeafBatch> insides_{};
  std::array<NodeStatistics, kLeafBatch> statistics_{};
  std::vector<std::byte> bytes_;
  std::vector<LeafRecord> records_;
};

}  // namespace

void encode_leaves(VolumeSource& source, const BlockPlan& plan, const EncodeTarget& target,
                   const StreamOptions& options) {
  const TreeRegions& tree = target.tree;
  std::vector<Box> leaf_boxes;
  std::vector<Box> voxel_boxes;
  for (std::int64_t i = 0; i < plan.size(); ++i) {
    const Box kept = trim_to_kept(tree, target.masks, plan.leaf_box(i));
    if (kept.empty()) continue;
    leaf_boxes.push_back(kept);
    voxel_boxes.push_back(plan.voxel_box(kept));
  }
  tbb::enumerable_thread_specific<LayerEncoder> encoders;
  stream_blocks(source, voxel_boxes, options, [&](const Block& block) {
    const Box& leaf_box = leaf_boxes[block.index];
    const Box regions = regions_under(tree, leaf_box);
    tbb::parallel_for(std::int64_t{0}, volume(regions.extent()), [&](std::int64_t i) {
      const std::int64_t region = tree.region_lattice.linear(regions.lo + index_at(i, regions.extent()));
      if (tree.regions[static_cast<std::size_t>(region)].leaves == 0) return;
      const LeafMask mask = target.masks.read(region);
      const Box box = intersect(tree.leaf_box(region), leaf_box);
      tbb::parallel_for(box.lo.x, box.hi.x,
                        [&](std::int64_t x) { encoders.local().run(target, block, leaf_box, region, mask, x); });
    });
  });
}

}  // namespace weir
