#include "compressor/encode/encode.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "compressor/encode/coded_regions.h"
#include "compressor/encode/leaf_encoder.h"
#include "compressor/encode/packed_encoder.h"
#include "compressor/encode/resident_encode.h"
#include "compressor/survey/cached_source.h"
#include "compressor/survey/rows_to_read.h"
#include "compressor/survey/surveyed_leaves.h"
#include "compressor/team/region_share.h"

namespace weir {
namespace {

// Returns the regions under a box of leaf-lattice positions, as a box of region-lattice positions.
Box regions_under(const TreeRegions& tree, const Box& leaf_box) {
  const Index3 lo = floor_div(tree.leaves.first + leaf_box.lo, kLowerLeaves) - tree.region_lattice.first;
  const Index3 last =
      floor_div(tree.leaves.first + leaf_box.hi - Index3{1, 1, 1}, kLowerLeaves) - tree.region_lattice.first;
  return {lo, last + Index3{1, 1, 1}};
}

// Returns the part of `block` (lattice positions) to read: the rows along x that hold kept leaves.
Box trim_to_kept(const TreeRegions& tree, const ChoiceStore& store, const Box& block) {
  RowsToRead kept(block);
  for_each_index(regions_under(tree, block), [&](const Index3& at) {
    const std::int64_t region = tree.region_lattice.linear(at);
    if (tree.regions[static_cast<std::size_t>(region)].leaves == 0) return;
    const LeafChoices choices = store.read(region);
    for_each_index(intersect(tree.leaf_box(region), block), [&](const Index3& leaf) {
      if (choices.kept(tree.mask_position(leaf))) kept.add(leaf);
    });
  });
  return kept.box();
}

std::unique_ptr<LayerEncoder> make_encoder(const EncodeTarget& target) {
  return target.packed != nullptr ? make_packed_encoder(target) : make_leaf_encoder(target);
}

// Loads the values of a block into the coder. Returns null if there is no coder, or if it cannot take the block.
std::unique_ptr<LoadedBlocks> load_block(const EncodeTarget& target, const Block& block, const Box& leaf_box) {
  if (target.packed == nullptr || target.packed->coder == nullptr) return nullptr;
  return target.packed->coder->load(block.values, block.voxels, target.tree.leaves.nodes_box(leaf_box));
}

// Does what for_each_layer() does, in batches of regions. A coder writes the streams of the next batch while this
// function visits the layers of the current one.
template <typename ForEach, typename Visit>
void for_each_coded_layer(const EncodeTarget& target, const SourceInfo& info, const Box& leaf_box, LoadedBlocks& loaded,
                          const ForEach& for_each, const Visit& visit) {
  const TreeRegions& tree = target.tree;
  std::vector<std::int64_t> regions;
  for_each_index(regions_under(tree, leaf_box), [&](const Index3& at) {
    const std::int64_t region = tree.region_lattice.linear(at);
    if (tree.regions[static_cast<std::size_t>(region)].leaves > 0) regions.push_back(region);
  });
  std::span<const std::int64_t> left(regions);
  const auto begin_next = [&] {
    auto batch = std::make_unique<CodedBatch>(target, leaf_box, left, loaded);
    left = left.subspan(batch->regions().size());
    return batch;
  };
  std::unique_ptr<CodedBatch> next = left.empty() ? nullptr : begin_next();
  while (next) {
    const std::unique_ptr<CodedBatch> batch = std::move(next);
    if (!left.empty()) next = begin_next();
    batch->wait();
    const std::span<const CodedBatch::Region> part = batch->regions();
    for_each(std::int64_t{0}, static_cast<std::int64_t>(part.size()), [&](std::int64_t i) {
      const CodedBatch::Region& region = part[static_cast<std::size_t>(i)];
      const SurveyedLeaves surveyed(target.rows, region.box, info);
      for_each(region.box.lo.x, region.box.hi.x,
               [&](std::int64_t x) { visit(region.index, region.places, surveyed, x, &region.coded); });
    });
  }
}

// Calls visit(region, places, surveyed, x, coded) for every x layer of every region of a block that holds kept leaves.
// `for_each(begin, end, action)` is the loop to use. `visit` may get a null `coded`.
template <typename ForEach, typename Visit>
void for_each_layer(const EncodeTarget& target, const SourceInfo& info, const Block& block, const Box& leaf_box,
                    const ForEach& for_each, const Visit& visit) {
  if (const std::unique_ptr<LoadedBlocks> loaded = load_block(target, block, leaf_box)) {
    for_each_coded_layer(target, info, leaf_box, *loaded, for_each, visit);
    return;
  }
  const TreeRegions& tree = target.tree;
  const Box regions = regions_under(tree, leaf_box);
  for_each(std::int64_t{0}, volume(regions.extent()), [&](std::int64_t i) {
    const std::int64_t region = tree.region_lattice.linear(regions.lo + index_at(i, regions.extent()));
    if (tree.regions[static_cast<std::size_t>(region)].leaves == 0) return;
    const RegionPlaces places = places_of(target, region);
    const Box box = intersect(tree.leaf_box(region), leaf_box);
    const SurveyedLeaves surveyed(target.rows, box, info, block.held == nullptr);
    for_each(box.lo.x, box.hi.x, [&](std::int64_t x) { visit(region, places, surveyed, x, nullptr); });
  });
}

// Encodes the leaves of a block on the calling thread.
void encode_alone(const EncodeTarget& target, const SourceInfo& info, const Block& block, const Box& leaf_box,
                  LayerEncoder& encoder) {
  const auto in_turn = [](std::int64_t begin, std::int64_t end, const auto& action) {
    for (std::int64_t i = begin; i < end; ++i) action(i);
  };
  for_each_layer(target, info, block, leaf_box, in_turn,
                 [&](std::int64_t region, const RegionPlaces& places, const SurveyedLeaves& surveyed, std::int64_t x,
                     const CodedRegion* coded) {
                   const TraceSpan span(target.trace, "encode");
                   encoder.add_layer(block, leaf_box, region, places, surveyed, x, coded);
                 });
  encoder.finish();
}

using LayerEncoders = tbb::enumerable_thread_specific<std::unique_ptr<LayerEncoder>>;

// Encodes the leaves of a block on TBB's workers, too.
void encode_shared(const EncodeTarget& target, const SourceInfo& info, const Block& block, const Box& leaf_box,
                   LayerEncoders& encoders) {
  const auto in_parallel = [](std::int64_t begin, std::int64_t end, const auto& action) {
    tbb::parallel_for(begin, end, action);
  };
  for_each_layer(target, info, block, leaf_box, in_parallel,
                 [&](std::int64_t region, const RegionPlaces& places, const SurveyedLeaves& surveyed, std::int64_t x,
                     const CodedRegion* coded) {
                   const TraceSpan span(target.trace, "encode");
                   LayerEncoder& encoder = *encoders.local();
                   encoder.add_layer(block, leaf_box, region, places, surveyed, x, coded);
                   encoder.finish();
                 });
}

// What is left to be encoded. All boxes hold leaf-lattice positions, except `voxel_boxes`.
struct EncodeWork {
  std::vector<Box> parts;            // the boxes that are not done
  std::vector<Box> leaf_boxes;       // the parts, each cut to the rows with kept leaves
  std::vector<Box> voxel_boxes;      // the voxels of each leaf box
  std::vector<std::size_t> part_of;  // the index in `parts` of each leaf box

  // Returns how many parts are done when the first `boxes` leaf boxes are done.
  std::size_t parts_done(std::size_t boxes) const { return boxes == part_of.size() ? parts.size() : part_of[boxes]; }
};

EncodeWork work_left(const BlockPlan& plan, const EncodeTarget& target, const EncodedState& known) {
  EncodeWork work;
  const OwnLeaves own(plan.lattice, target.rows.team());
  for (std::int64_t i = 0; i < plan.size(); ++i) {
    for (const Box& missing : known.done.missing_from(plan.leaf_box(i))) {
      for (const Box& part : own.of(missing)) {
        work.parts.push_back(part);
        const Box kept = trim_to_kept(target.tree, target.choices, part);
        if (kept.empty()) continue;
        work.leaf_boxes.push_back(kept);
        work.voxel_boxes.push_back(plan.voxel_box(kept));
        work.part_of.push_back(work.parts.size() - 1);
      }
    }
  }
  return work;
}

void encode_boxes(VolumeSource& source, const EncodeWork& work, const EncodeTarget& target,
                  const StreamOptions& options, Reading reading, LayerEncoders& encoders) {
  if (reading == Reading::in_place) {
    work_in_place(source, work.voxel_boxes, options, [&](const Block& block) {
      encode_alone(target, source.info(), block, work.leaf_boxes[block.index], *encoders.local());
    });
    return;
  }
  CachedSource cached(source, target.rows.cache());
  stream_blocks(cached, work.voxel_boxes, options, [&](const Block& block) {
    encode_shared(target, source.info(), block, work.leaf_boxes[block.index], encoders);
  });
}

}  // namespace

bool encodes_by_regions(VolumeSource& source, bool packed, const Team& team, bool resumes) {
  return source.resident() != nullptr && packed && team.alone() && !resumes;
}

void encode_leaves(VolumeSource& source, const BlockPlan& plan, const EncodeTarget& target,
                   const StreamOptions& options, Reading reading, EncodedState* state, const Pauses& pauses) {
  if (encodes_by_regions(source, target.packed != nullptr, target.rows.team(), state != nullptr)) {
    return encode_resident(*source.resident(), source, target, options);
  }
  EncodedState nothing;
  EncodedState& known = state == nullptr ? nothing : *state;
  const EncodedSums before = known.sums;
  const EncodeWork work = work_left(plan, target, known);
  LayerEncoders encoders([&] { return make_encoder(target); });
  std::size_t told = 0;
  const auto tell = [&](std::size_t boxes_done) {
    for (const std::size_t end = work.parts_done(boxes_done); told < end; ++told) known.done.add(work.parts[told]);
    known.sums = before;
    for (const std::unique_ptr<LayerEncoder>& encoder : encoders) known.sums.add(encoder->sums());
  };
  StreamOptions stream = options;
  stream.in_parts = target.packed == nullptr || target.packed->coder == nullptr;  // a coder needs all voxels
  if (pauses.due) {
    stream.at_rest = [&](std::size_t boxes_done) {
      if (!pauses.due()) return;
      tell(boxes_done);
      pauses.save();
    };
  }
  encode_boxes(source, work, target, stream, reading, encoders);
  tell(work.voxel_boxes.size());
}

}  // namespace weir
