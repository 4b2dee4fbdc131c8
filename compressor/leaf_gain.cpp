#include "compressor/leaf_gain.h"

#include <algorithm>
#include <cmath>

namespace weir {
namespace {

struct BrickRange {
  float low = 0;
  float high = 0;
  bool any = false;
};

double distance(Metric metric, const BrickRange& range, float background) {
  if (!range.any) return 0;
  const auto low = static_cast<double>(range.low);
  const auto high = static_cast<double>(range.high);
  const auto b = static_cast<double>(background);
  switch (metric) {
    case Metric::closest:
      return std::min(std::abs(low - b), std::abs(high - b));
    case Metric::farthest:
      return std::max(std::abs(low - b), std::abs(high - b));
    case Metric::median:
      return std::abs((low + high) / 2 - b);
    case Metric::sse:
      break;
  }
  return 0;
}

}  // namespace

void GainRule::gains(const TreeRegions& tree, const RegionRows& rows, std::vector<LeafGain>& out) const {
  const NodeLattice& leaves = tree.leaves;
  const Index3 last_leaf = leaves.count - Index3{1, 1, 1};
  const std::int64_t side = metric == Metric::sse ? 1 : brick_leaves;
  const std::int64_t bricks = kLowerLeaves / side;
  out.clear();
  const bool whole =
      leaves.voxels(rows.leaf_box().lo) == leaves.node_box(rows.leaf_box().lo) &&
      leaves.voxels(rows.leaf_box().hi - Index3{1, 1, 1}) == leaves.node_box(rows.leaf_box().hi - Index3{1, 1, 1});
  rows.for_each([&](const Index3& leaf, const LeafRow& row) {
    const Index3 node = leaves.first + leaf;
    const Index3 entry{node.x & (kLowerLeaves - 1), node.y & (kLowerLeaves - 1), node.z & (kLowerLeaves - 1)};
    const std::int64_t voxels = whole ? kLeafVoxels : leaves.voxels(leaf).voxels();
    LeafGain gain;
    gain.position = static_cast<std::uint16_t>(entry.x << 8 | entry.y << 4 | entry.z);
    gain.brick = static_cast<std::uint32_t>(
        linear_index({entry.x / side, entry.y / side, entry.z / side}, {bricks, bricks, bricks}));
    gain.required = leaf == Index3{0, 0, 0} || leaf == last_leaf ||
                    (fill.non_finite == NonFinitePolicy::keep && row.finite < voxels);
    const float tile = fill.leaf_value(row);
    gain.exact = fill.exact(row, voxels, tile);
    if (metric == Metric::sse && !gain.exact) gain.gain = row.sse_about(tile);
    out.push_back(gain);
  });
  if (metric != Metric::sse) rank_bricks(rows, out);
}

void GainRule::rank_bricks(const RegionRows& rows, std::vector<LeafGain>& leaves) const {
  std::vector<BrickRange> ranges(kLowerLeaves * kLowerLeaves * kLowerLeaves);
  auto leaf = leaves.begin();
  rows.for_each([&](const Index3&, const LeafRow& row) {
    BrickRange& range = ranges[(leaf++)->brick];
    if (row.finite == 0) return;
    range.low = range.any ? std::min(range.low, row.min) : row.min;
    range.high = range.any ? std::max(range.high, row.max) : row.max;
    range.any = true;
  });
  for (LeafGain& gain : leaves) {
    if (!gain.exact) gain.gain = distance(metric, ranges[gain.brick], fill.background);
  }
}

}  // namespace weir
