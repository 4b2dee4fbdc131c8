#include "compressor/encode/encode.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "compressor/leaf/quantised_leaf.h"
#include "compressor/survey/surveyed_leaves.h"
#include "compressor/team/region_share.h"
#include "format/base/simd.h"
#include "format/leaf/leaf_codec.h"
#include "format/leaf/quantised_codec.h"

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
Box trim_to_kept(const TreeRegions& tree, const ChoiceStore& store, const Box& block) {
  Box kept{block.hi, block.lo};
  for_each_in(regions_under(tree, block), [&](const Index3& at) {
    const std::int64_t region = tree.region_lattice.linear(at);
    if (tree.regions[static_cast<std::size_t>(region)].leaves == 0) return;
    const LeafChoices choices = store.read(region);
    for_each_in(intersect(tree.leaf_box(region), block), [&](const Index3& leaf) {
      if (!choices.kept(tree.mask_position(leaf))) return;
      kept.lo = min(kept.lo, leaf);
      kept.hi = max(kept.hi, leaf + Index3{1, 1, 1});
    });
  });
  if (kept.empty()) return kept;
  kept.lo.x = block.lo.x;
  kept.hi.x = block.hi.x;
  return kept;
}

WEIR_SIMD bool all_finite(const LeafValues& values) {
  std::uint32_t others = 0;
  for (const float v : values) others |= v - v == 0.0F ? 0U : 1U;  // NaN for what is not finite
  return others == 0;
}

// Gathers kept leaves, computes their statistics a batch at a time, and writes runs of leaves that
// follow each other in the file. One per thread.
class LeafEncoder {
 public:
  // The kept leaves of one x layer of one region, as far as they lie in the block.
  void add_layer(const EncodeTarget& target, const Block& block, const Box& leaf_box, std::int64_t region_index,
                 const LeafPlaces& places, const SurveyedLeaves& surveyed, std::int64_t x) {
    const TreeRegions& tree = target.tree;
    const Region& region = tree.regions[static_cast<std::size_t>(region_index)];
    const Box box = intersect(tree.leaf_box(region_index), leaf_box);
    for (std::int64_t y = box.lo.y; y < box.hi.y; ++y) {
      for (std::int64_t z = box.lo.z; z < box.hi.z; ++z) {
        const Index3 leaf{x, y, z};
        const std::size_t position = tree.mask_position(leaf);
        if (!places.kept(position)) continue;
        surveyed.check(leaf, block.values, block.voxels);
        const LeafPlaces::Place before = places.before(position);
        const LeafWidth width = places.width(position);
        gather(target, block, leaf,
               {region.first_leaf + before.leaves, target.layout.leaves + region.first_byte + before.bytes, width});
      }
    }
  }

  // Writes what is still held; call before the thread turns to another block.
  void finish(const EncodeTarget& target) {
    encode_batch(target);
    const std::span<const std::byte> bytes(bytes_);
    std::size_t at = 0;
    for (std::size_t first = 0; first < leaves_.size();) {
      std::size_t end = first;
      std::size_t size = 0;
      do {
        size += leaf_bytes(leaves_[end++].width);
      } while (end < leaves_.size() && leaves_[end].ordinal == leaves_[end - 1].ordinal + 1);
      const TraceSpan span(target.trace, "write", size);
      target.out.write_at(leaves_[first].offset, bytes.subspan(at, size));
      target.records.write(leaves_[first].ordinal, std::span(records_).subspan(first, end - first));
      at += size;
      first = end;
    }
    bytes_.clear();
    records_.clear();
    leaves_.clear();
  }

 private:
  static constexpr std::size_t kHeldLeaves = 256;  // 570 KiB with their records

  // A kept leaf's place in the file.
  struct Leaf {
    std::uint64_t ordinal;
    std::uint64_t offset;
    LeafWidth width;
  };

  void gather(const EncodeTarget& target, const Block& block, const Index3& leaf, const Leaf& place) {
    const Box node = target.tree.leaves.node_box(leaf);
    const Box inside = target.tree.leaves.voxels(leaf);
    LeafValues& values = values_[batch_];
    gather_leaf(block.values, block.voxels, node, inside, target.fill.background, values);
    finite_[batch_] = all_finite(values);
    if (!finite_[batch_] && target.fill.non_finite != NonFinitePolicy::keep) {
      sources_[batch_] = values;
      for (float& v : values) v = std::isfinite(v) ? v : target.fill.background;
    }
    nodes_[batch_] = node;
    insides_[batch_] = inside;
    leaves_.push_back(place);
    if (++batch_ == kLeafBatch) encode_batch(target);
    if (leaves_.size() >= kHeldLeaves) finish(target);
  }

  void encode_batch(const EncodeTarget& target) {
    const std::size_t first = leaves_.size() - batch_;
    if (target.type != GridType::float32) {
      for (std::size_t i = 0; i < batch_; ++i) {
        const LeafValues& source = finite_[i] ? values_[i] : sources_[i];
        const Leaf& leaf = leaves_[first + i];
        quantised_[i] = quantise_leaf(values_[i], source, nodes_[i], insides_[i], bits_log2_of(leaf.width), target.fit);
        values_[i] = quantised_[i].decoded;
      }
    }
    const std::span<NodeStatistics> statistics(statistics_.data(), batch_);
    full_leaf_statistics({values_.data(), batch_}, {nodes_.data(), batch_}, statistics);
    for (std::size_t i = 0; i < batch_; ++i) {
      if (insides_[i] != nodes_[i]) statistics[i] = leaf_statistics(values_[i], nodes_[i], insides_[i]);
      const std::size_t at = bytes_.size();
      bytes_.resize(at + leaf_bytes(leaves_[first + i].width));
      const std::span<std::byte> image = std::span(bytes_).subspan(at);
      records_.push_back(make_leaf_record(values_[i], nodes_[i], insides_[i], statistics[i]));
      if (target.type == GridType::float32) {
        encode_float_leaf(values_[i], nodes_[i], insides_[i], statistics[i], image.first<nvdb::kFloatLeafBytes>());
      } else {
        const QuantisedLeaf& leaf = quantised_[i];
        encode_quantised_leaf(target.type, leaf.codes, leaf.bits_log2, leaf.quantiser.minimum, leaf.quantiser.quantum,
                              nodes_[i], insides_[i], statistics[i], image);
        records_.back().squared_error = leaf.squared_error;
        records_.back().max_abs = leaf.max_abs;
        records_.back().exact = leaf.exact ? 1 : 0;
      }
    }
    batch_ = 0;
  }

  std::size_t batch_ = 0;  // leaves gathered and not yet encoded: the last ones of leaves_
  std::array<LeafValues, kLeafBatch> values_{};
  std::array<LeafValues, kLeafBatch> sources_{};  // before non-finite values were replaced; where there are any
  std::array<bool, kLeafBatch> finite_{};
  std::array<QuantisedLeaf, kLeafBatch> quantised_{};
  std::array<Box, kLeafBatch> nodes_{};
  std::array<Box, kLeafBatch> insides_{};
  std::array<NodeStatistics, kLeafBatch> statistics_{};
  std::vector<Leaf> leaves_;  // held, encoded or not
  std::vector<std::byte> bytes_;
  std::vector<LeafRecord> records_;
};

// Calls visit(region, places, surveyed, x) for every x layer of every region of a block that holds kept leaves;
// `for_each(begin, end, action)` is the loop to use.
template <typename ForEach, typename Visit>
void for_each_layer(const EncodeTarget& target, const SourceInfo& info, const Box& leaf_box, const ForEach& for_each,
                    const Visit& visit) {
  const TreeRegions& tree = target.tree;
  const Box regions = regions_under(tree, leaf_box);
  for_each(std::int64_t{0}, volume(regions.extent()), [&](std::int64_t i) {
    const std::int64_t region = tree.region_lattice.linear(regions.lo + index_at(i, regions.extent()));
    if (tree.regions[static_cast<std::size_t>(region)].leaves == 0) return;
    const LeafPlaces places(target.choices.read(region));
    const Box box = intersect(tree.leaf_box(region), leaf_box);
    const SurveyedLeaves surveyed(target.rows, box, info);
    for_each(box.lo.x, box.hi.x, [&](std::int64_t x) { visit(region, places, surveyed, x); });
  });
}

}  // namespace

void encode_leaves(VolumeSource& source, const BlockPlan& plan, const EncodeTarget& target,
                   const StreamOptions& options, Reading reading, BoxSet* done, const Pauses& pauses) {
  const TreeRegions& tree = target.tree;
  BoxSet nothing;
  BoxSet& known = done == nullptr ? nothing : *done;
  const OwnLeaves own(plan.lattice, target.rows.team());
  std::vector<Box> parts;  // what is not done
  std::vector<Box> leaf_boxes;
  std::vector<Box> voxel_boxes;
  std::vector<std::size_t> part_of;  // by leaf box
  for (std::int64_t i = 0; i < plan.size(); ++i) {
    for (const Box& missing : known.missing_from(plan.leaf_box(i))) {
      for (const Box& part : own.of(missing)) {
        parts.push_back(part);
        const Box kept = trim_to_kept(tree, target.choices, part);
        if (kept.empty()) continue;
        leaf_boxes.push_back(kept);
        voxel_boxes.push_back(plan.voxel_box(kept));
        part_of.push_back(parts.size() - 1);
      }
    }
  }
  std::size_t told = 0;
  const auto tell = [&](std::size_t boxes_done) {
    const std::size_t end = boxes_done == part_of.size() ? parts.size() : part_of[boxes_done];
    for (; told < end; ++told) known.add(parts[told]);
  };
  StreamOptions stream = options;
  if (pauses.due) {
    stream.at_rest = [&](std::size_t boxes_done) {
      if (!pauses.due()) return;
      tell(boxes_done);
      pauses.save();
    };
  }
  tbb::enumerable_thread_specific<LeafEncoder> encoders;
  if (reading == Reading::in_place) {
    const auto in_turn = [](std::int64_t begin, std::int64_t end, const auto& action) {
      for (std::int64_t i = begin; i < end; ++i) action(i);
    };
    work_in_place(source, voxel_boxes, stream, [&](const Block& block) {
      const Box& leaf_box = leaf_boxes[block.index];
      LeafEncoder& encoder = encoders.local();
      for_each_layer(
          target, source.info(), leaf_box, in_turn,
          [&](std::int64_t region, const LeafPlaces& places, const SurveyedLeaves& surveyed, std::int64_t x) {
            const TraceSpan span(target.trace, "encode");
            encoder.add_layer(target, block, leaf_box, region, places, surveyed, x);
          });
      encoder.finish(target);
    });
    tell(voxel_boxes.size());
    return;
  }
  const auto in_parallel = [](std::int64_t begin, std::int64_t end, const auto& action) {
    tbb::parallel_for(begin, end, action);
  };
  stream_blocks(source, voxel_boxes, stream, [&](const Block& block) {
    const Box& leaf_box = leaf_boxes[block.index];
    for_each_layer(target, source.info(), leaf_box, in_parallel,
                   [&](std::int64_t region, const LeafPlaces& places, const SurveyedLeaves& surveyed, std::int64_t x) {
                     const TraceSpan span(target.trace, "encode");
                     LeafEncoder& encoder = encoders.local();
                     encoder.add_layer(target, block, leaf_box, region, places, surveyed, x);
                     encoder.finish(target);
                   });
  });
  tell(voxel_boxes.size());
}

}  // namespace weir
