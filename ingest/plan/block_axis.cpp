#include "ingest/plan/block_axis.h"

#include <algorithm>
#include <numeric>

#include "format/base/index.h"

namespace weir {
namespace {

/// Cuts are tried with lengths of 1 to this many leaves or units, and into 1 to this many equal parts.
constexpr std::int64_t kCutsTried = 64;
/// The number of blocks that a cut is judged by. The pattern of blocks and chunks repeats, so more are not needed.
constexpr std::int64_t kBlocksJudged = 4096;

}  // namespace

BlockAxis::BlockAxis(std::int64_t domain_lo, std::int64_t domain_hi, std::int64_t chunk_voxels, std::int64_t edge)
    : lo(domain_lo),
      hi(domain_hi),
      first(floor_div(domain_lo, kLeafDim)),
      count(floor_div(domain_hi - 1, kLeafDim) + 1 - first),
      chunk(chunk_voxels),
      chunk_edge(edge) {
  // If chunk edges are off the leaf lattice, no block of leaves ends with a chunk.
  if (chunk > 0 && chunk_edge % kLeafDim == 0) unit = std::min(std::lcm(chunk, kLeafDim) / kLeafDim, count);
  size = unit;
}

std::int64_t BlockAxis::step() const { return unit * ceil_div(kLowerLeaves, unit); }

std::int64_t BlockAxis::lead() const {
  if (whole()) return 0;
  const std::int64_t anchor = unit > 1 ? floor_div(chunk_edge, kLeafDim) : 0;
  return first - anchor - floor_div(first - anchor, size) * size;
}

std::int64_t BlockAxis::blocks() const { return ceil_div(count + lead(), size); }
std::int64_t BlockAxis::begin(std::int64_t k) const { return std::max<std::int64_t>(k * size - lead(), 0); }
std::int64_t BlockAxis::end(std::int64_t k) const { return std::min((k + 1) * size - lead(), count); }

std::int64_t BlockAxis::voxels(std::int64_t k) const {
  return std::min((first + end(k)) * kLeafDim, hi) - std::max((first + begin(k)) * kLeafDim, lo);
}

std::int64_t BlockAxis::longest() const {
  const std::int64_t n = blocks();
  return std::max({voxels(0), voxels(std::min<std::int64_t>(1, n - 1)), voxels(n - 1)});
}

double BlockAxis::amplification(std::int64_t most_blocks) const {
  if (chunk == 0) return 1;
  const auto chunks = [&](std::int64_t from, std::int64_t to) {
    return floor_div(to - 1 - chunk_edge, chunk) - floor_div(from - chunk_edge, chunk) + 1;
  };
  std::int64_t decoded = 0;
  std::int64_t from = lo;
  for (std::int64_t k = 0; k < std::min(blocks(), most_blocks); ++k) {
    const std::int64_t to = from + voxels(k);
    decoded += chunks(from, to);
    from = to;
  }
  return static_cast<double>(decoded) / static_cast<double>(chunks(lo, from));
}

std::vector<AxisCut> useful_cuts(BlockAxis axis) {
  std::vector<std::int64_t> sizes;
  for (std::int64_t k = 1; k <= kCutsTried; ++k) {
    for (const std::int64_t size : {k, ceil_div(axis.count, k), k * axis.unit}) {
      sizes.push_back(std::min(size, axis.count));
    }
  }
  std::vector<AxisCut> cuts;
  for (const std::int64_t size : sizes) {
    axis.size = size;
    cuts.push_back({size, axis.longest(), axis.amplification(kBlocksJudged)});
  }
  std::ranges::sort(cuts, [](const AxisCut& a, const AxisCut& b) {
    return a.longest != b.longest ? a.longest < b.longest : a.amplification < b.amplification;
  });
  std::vector<AxisCut> useful;
  for (const AxisCut& cut : cuts) {
    if (useful.empty() || cut.amplification < useful.back().amplification) useful.push_back(cut);
  }
  return useful;
}

}  // namespace weir
