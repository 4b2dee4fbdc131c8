#include "compressor/compare/pair_stream.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <span>
#include <vector>

#include "compressor/team/region_share.h"
#include "format/nanovdb/read_box.h"
#include "ingest/plan/block_plan.h"
#include "ingest/plan/block_stream.h"

namespace weir {
namespace {

Box with_margin(const Box& box, const PairMargin& margin, const Box& domain) {
  const auto cube = [](std::int64_t n) { return Index3{n, n, n}; };
  return intersect({box.lo - cube(margin.below), box.hi + cube(margin.above)}, domain);
}

/// The blocks to stream, and the box of each with its margin.
struct PairPlan {
  NodeLattice lattice;       ///< lattice of leaves, 8^3 voxels each
  std::vector<Box> leaves;   ///< lattice positions of the leaves of each block
  std::vector<Box> boxes;    ///< voxels of each block with its margin
  std::int64_t largest = 0;  ///< voxels of the largest box
  std::int64_t voxels = 0;   ///< voxels of all blocks without margins
};

// Halves the blocks until no box is larger than twice `block_bytes`, or until the blocks are down to 64 KiB. The margin
// of a small block is larger than the block itself, so that smaller ones would not help.
PairPlan plan_pairs(const VolumeSource& source, const PairMargin& margin, std::uint64_t block_bytes, const Team& team) {
  constexpr std::uint64_t kLeast = std::uint64_t{64} << 10U;
  const Box domain = source.info().domain();
  PairPlan plan;
  for (std::uint64_t bytes = block_bytes;; bytes /= 2) {
    const BlockPlan blocks = plan_blocks(domain, source.access(), bytes);
    const OwnLeaves own(blocks.lattice, team);
    plan = {blocks.lattice, {}, {}, 0, 0};
    for (std::int64_t i = 0; i < blocks.size(); ++i) {
      for (const Box& leaves : own.of(blocks.leaf_box(i))) {
        plan.leaves.push_back(leaves);
        plan.boxes.push_back(with_margin(blocks.voxel_box(leaves), margin, domain));
        plan.voxels += blocks.voxel_box(leaves).voxels();
        plan.largest = std::max(plan.largest, plan.boxes.back().voxels());
      }
    }
    const std::uint64_t taken = static_cast<std::uint64_t>(plan.largest) * sizeof(float);
    if (taken <= 2 * block_bytes || bytes <= kLeast) return plan;
  }
}

/// Decodes boxes of grids. Releases pages before more than CompareOptions::page_bytes of them are resident.
class Decoder {
 public:
  explicit Decoder(const CompareOptions& options)
      : options_(options), most_(static_cast<std::int64_t>(options.page_bytes / kPagesOfLeaf)) {}

  void decode(const NvdbGrid& grid, const Box& box, std::span<float> values) {
    const NodeLattice leaves = make_lattice(box, kLeafDim);
    const Index3 pieces{(leaves.count.x + kPiece - 1) / kPiece, leaves.count.y, leaves.count.z};
    tbb::parallel_for(std::int64_t{0}, volume(pieces), [&](std::int64_t i) {
      const Index3 at = index_at(i, pieces);
      const Index3 first{at.x * kPiece, at.y, at.z};
      const Index3 last{std::min(first.x + kPiece, leaves.count.x) - 1, at.y, at.z};
      read_box_part(grid, {leaves.voxels(first).lo, leaves.voxels(last).hi}, box, values);
      count(last.x - first.x + 1);
    });
  }

 private:
  static constexpr std::int64_t kPiece = 16;  // leaves along x
  // The system maps the 64 KiB around a page that is read, if they are in the page cache, or more if more pages lie
  // together there: 161 KiB were seen.
  static constexpr std::uint64_t kPagesOfLeaf = std::uint64_t{256} << 10U;

  void count(std::int64_t leaves) {
    if (!options_.release_pages || (leaves_ += leaves) < most_) return;
    leaves_ = 0;
    options_.release_pages();
  }

  const CompareOptions& options_;
  std::int64_t most_;
  std::atomic<std::int64_t> leaves_{0};  // leaves decoded since pages were last released
};

}  // namespace

void stream_pairs(VolumeSource& source, const NvdbGrid& grid, const PairMargin& margin, const CompareOptions& options,
                  const std::function<void(const ValuePair&, const Box&)>& visit, const Team& team) {
  const PairedVolume one{source, grid};
  stream_pairs(
      std::span(&one, 1), margin, options,
      [&](std::span<const ValuePair> values, const Box& part) { visit(values.front(), part); }, team);
}

void stream_pairs(std::span<const PairedVolume> volumes, const PairMargin& margin, const CompareOptions& options,
                  const std::function<void(std::span<const ValuePair>, const Box&)>& visit, const Team& team) {
  VolumeSource& first = volumes.front().source;
  const Box domain = first.info().domain();
  const PairPlan plan = plan_pairs(first, margin, options.block_bytes, team);
  const auto largest = static_cast<std::size_t>(plan.largest);
  std::vector<std::vector<float>> decoded(volumes.size(), std::vector<float>(largest));
  std::vector<std::vector<float>> read(volumes.size() - 1, std::vector<float>(largest));
  Decoder decoder(options);
  StreamOptions stream;
  stream.cancel = options.cancel;
  stream.trace = options.trace;
  if (options.progress) {
    stream.progress = [&](std::int64_t done, std::int64_t total) {
      const double share = static_cast<double>(done) / static_cast<double>(total);
      options.progress(static_cast<std::uint64_t>(share * static_cast<double>(plan.voxels)) * sizeof(float));
    };
  }
  stream_blocks(first, plan.boxes, stream, [&](const Block& block) {
    const TraceSpan span(options.trace, "compare", block.values.size_bytes());
    std::vector<ValuePair> pairs;
    for (std::size_t k = 0; k < volumes.size(); ++k) {
      std::span<const float> source = block.values;
      if (k > 0) {
        const std::span<float> values = std::span(read[k - 1]).first(block.values.size());
        volumes[k].source.read(block.voxels, values);
        source = values;
      }
      const std::span<float> values = std::span(decoded[k]).first(block.values.size());
      decoder.decode(volumes[k].grid, block.voxels, values);
      pairs.push_back({domain, block.voxels, source, values});
    }
    const Box& leaves = plan.leaves[block.index];
    tbb::parallel_for(std::int64_t{0}, leaves.voxels(), [&](std::int64_t i) {
      visit(pairs, plan.lattice.voxels(leaves.lo + index_at(i, leaves.extent())));
    });
  });
}

}  // namespace weir
