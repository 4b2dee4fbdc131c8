#include "compressor/compare/pair_stream.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <vector>

#include "format/nanovdb/read_box.h"
#include "ingest/plan/block_plan.h"
#include "ingest/plan/block_stream.h"

namespace weir {
namespace {

Box with_margin(const Box& box, const PairMargin& margin, const Box& domain) {
  const auto cube = [](std::int64_t n) { return Index3{n, n, n}; };
  return intersect({box.lo - cube(margin.below), box.hi + cube(margin.above)}, domain);
}

/// Blocks, and each with its margin.
struct PairPlan {
  BlockPlan blocks;
  std::vector<Box> boxes;
  std::int64_t largest = 0;  ///< voxels of the largest box
};

// Margins of small blocks are larger than they: blocks are halved until boxes are below twice `block_bytes`, or have
// become as small as they can be of use.
PairPlan plan_pairs(const VolumeSource& source, const PairMargin& margin, std::uint64_t block_bytes) {
  constexpr std::uint64_t kLeast = std::uint64_t{64} << 10U;
  const Box domain = source.info().domain();
  PairPlan plan;
  for (std::uint64_t bytes = block_bytes;; bytes /= 2) {
    plan = {plan_blocks(domain, source.access(), bytes), {}, 0};
    for (std::int64_t i = 0; i < plan.blocks.size(); ++i) {
      plan.boxes.push_back(with_margin(plan.blocks.voxel_box(plan.blocks.leaf_box(i)), margin, domain));
      plan.largest = std::max(plan.largest, plan.boxes.back().voxels());
    }
    const std::uint64_t taken = static_cast<std::uint64_t>(plan.largest) * sizeof(float);
    if (taken <= 2 * block_bytes || bytes <= kLeast) return plan;
  }
}

// Layers of 8 voxels in z, each decoded by one thread; a layer's values lie side by side.
void decode(const NvdbGrid& grid, const Box& box, std::span<float> values) {
  const NodeLattice layers = make_lattice(Box{{0, 0, box.lo.z}, {1, 1, box.hi.z}}, kLeafDim);
  const std::int64_t plane = box.extent().x * box.extent().y;
  tbb::parallel_for(std::int64_t{0}, layers.count.z, [&](std::int64_t i) {
    const Box z = layers.voxels({0, 0, i});
    const Box layer{{box.lo.x, box.lo.y, z.lo.z}, {box.hi.x, box.hi.y, z.hi.z}};
    read_box(grid, layer,
             values.subspan(static_cast<std::size_t>((z.lo.z - box.lo.z) * plane),
                            static_cast<std::size_t>(layer.voxels())));
  });
}

}  // namespace

void stream_pairs(VolumeSource& source, const NvdbGrid& grid, const PairMargin& margin, const CompareOptions& options,
                  const std::function<void(const ValuePair&, const Box&)>& visit) {
  const Box domain = source.info().domain();
  const PairPlan planned = plan_pairs(source, margin, options.block_bytes);
  const BlockPlan& plan = planned.blocks;
  const std::vector<Box>& boxes = planned.boxes;
  std::vector<float> decoded(static_cast<std::size_t>(planned.largest));
  StreamOptions stream;
  stream.cancel = options.cancel;
  stream.trace = options.trace;
  if (options.progress) {
    stream.progress = [&](std::int64_t done, std::int64_t total) {
      const double share = static_cast<double>(done) / static_cast<double>(total);
      options.progress(static_cast<std::uint64_t>(share * static_cast<double>(domain.voxels())) * sizeof(float));
    };
  }
  stream_blocks(source, boxes, stream, [&](const Block& block) {
    const TraceSpan span(options.trace, "compare", block.values.size_bytes());
    const std::span<float> values = std::span(decoded).first(block.values.size());
    decode(grid, block.voxels, values);
    if (options.release_pages) options.release_pages();
    const ValuePair pair{domain, block.voxels, block.values, values};
    const Box leaves = plan.leaf_box(static_cast<std::int64_t>(block.index));
    tbb::parallel_for(std::int64_t{0}, leaves.voxels(), [&](std::int64_t i) {
      visit(pair, plan.lattice.voxels(leaves.lo + index_at(i, leaves.extent())));
    });
  });
}

}  // namespace weir
