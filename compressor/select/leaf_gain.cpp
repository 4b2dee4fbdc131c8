#include "compressor/select/leaf_gain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "compressor/leaf/leaf_lattice.h"
#include "compressor/leaf/leaf_quantiser.h"
#include "format/leaf/bounds.h"
#include "format/packed/block_decode.h"

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

// Returns the rank, in its region, of the brick that holds `leaf`. A brick has kSide leaves along each axis.
template <std::int64_t kSide>
std::uint32_t brick_of(const Index3& leaf) {
  constexpr std::int64_t kBricks = kLowerLeaves / kSide;
  const auto along = [](std::int64_t at) { return (at & (kLowerLeaves - 1)) / kSide; };
  return static_cast<std::uint32_t>(
      linear_index({along(leaf.x), along(leaf.y), along(leaf.z)}, {kBricks, kBricks, kBricks}));
}

std::uint32_t brick_of(const Index3& leaf, std::int64_t side) {
  return side == 1 ? brick_of<1>(leaf) : side == 2 ? brick_of<2>(leaf) : brick_of<4>(leaf);
}

LeafStep step_to(LeafWidth width, LeafWidth from, double gain) {
  const std::uint32_t bytes = leaf_bytes(width) - leaf_bytes(from);
  return {gain, gain / static_cast<double>(bytes), bytes, static_cast<KeptLevel>(width)};
}

// Returns the bits a voxel that hold a leaf of `voxels` in-domain voxels without loss, with `background` in place of
// voxels without a finite value. 0: more than 16 bits, or not known.
unsigned exact_bits(const LeafRow& row, std::int64_t voxels, float background) {
  if (row.finite == voxels || row.exact_bits == 0) return row.exact_bits;
  const float low = std::min(row.min, background);
  const float high = std::max(row.max, background);
  if (low == high) return Fill::same_bits(row.min, background) ? 1 : 0;
  // Every value is min + k * step, and no lattice that is coarser holds them all: min and min + step stand for all.
  const unsigned largest = row.largest_code();
  const double step = largest == 0 ? 0 : (static_cast<double>(row.max) - static_cast<double>(row.min)) / largest;
  const std::array values{row.min, static_cast<float>(static_cast<double>(row.min) + step), row.max, background};
  const auto lattice = find_lattice(values, low, high);
  return lattice ? bits_for(lattice->largest) : 0;
}

// Returns the widest width of FpN that is useful to a leaf: a leaf that is exact needs no more bits.
LeafWidth widest(const LeafRow& row, std::int64_t voxels, float background) {
  const unsigned exact = exact_bits(row, voxels, background);
  LeafWidth width = LeafWidth::bits1;
  while (width != LeafWidth::bits16 && (exact == 0 || 1U << bits_log2_of(width) < exact)) {
    width = width_of(bits_log2_of(width) + 1);
  }
  return width;
}

// Adds the steps on the lower convex hull of (bytes, error) from width `from`, with error `error`, to width `last`.
// error_at(width) returns the error at a width.
template <typename ErrorAt>
void add_hull(const ErrorAt& error_at, LeafWidth from, double error, LeafWidth last, LeafGain& leaf, RegionGains& out) {
  std::array<double, 5> errors{};
  for (unsigned log2 = 0; log2 <= bits_log2_of(last); ++log2) errors[log2] = error_at(width_of(log2));
  double most = std::numeric_limits<double>::max();
  while (from != last) {
    LeafStep best{};
    for (auto log2 = static_cast<unsigned>(from); log2 <= bits_log2_of(last); ++log2) {
      const LeafStep step = step_to(width_of(log2), from, error - errors[log2]);
      if (step.gain > 0 && step.key > best.key) best = step;
    }
    if (best.level == 0) return;
    error -= best.gain;
    from = static_cast<LeafWidth>(best.level);
    most = best.key = std::min(best.key, most);  // where three errors lie on a line, quotients round up, too
    out.add(leaf, best);
  }
}

// Returns the width at which the leaf's last step keeps it.
LeafWidth last_width(const LeafGain& leaf) {
  return leaf.step_count == 0 ? LeafWidth::tile : static_cast<LeafWidth>(leaf.steps[leaf.step_count - 1].level);
}

// The least squared error that the survey estimated for a leaf of finite values at less than 1 << below_log2 bits,
// where below_log2 >= 1: more bits do not do worse.
double least_estimate(const LeafRow& row, unsigned below_log2) {
  const auto end = row.quantised.begin() + std::min<std::ptrdiff_t>(below_log2, std::ssize(row.quantised));
  return row.sse * static_cast<double>(*std::min_element(row.quantised.begin(), end));
}

}  // namespace

double quantised_error(const LeafRow& row, std::int64_t voxels, float background, LeafWidth width) {
  if (width == LeafWidth::float32) return 0;
  const unsigned log2 = bits_log2_of(width);
  const unsigned bits = 1U << log2;
  if (keeps_every_bit(row, voxels, background, width)) return 0;
  const bool all_finite = row.finite == voxels;
  if (all_finite && log2 < row.quantised.size()) return least_estimate(row, log2 + 1);
  // The survey did not know what would take the place of NaN: it may lie far from the other values.
  const float low = all_finite ? row.min : std::min(row.min, background);
  const float high = all_finite ? row.max : std::max(row.max, background);
  const auto quantum = static_cast<double>(range_quantiser({low, high, row.mean}, bits).quantum);
  const double least = all_finite ? least_estimate(row, log2) : row.sse;
  if (!(quantum > 0)) return least;  // float holds one level only, or not all of the range
  // Errors uniform over a quantum, q^2 / 12 a value; the ends of the range are levels. Sparse data has most of its
  // values there: without them 8 bits would seem bad enough for 16 to be bought.
  const int between = all_finite ? row.finite - row.at_ends : row.finite;
  return std::min(least, between * quantum * quantum / 12);
}

bool keeps_every_bit(const LeafRow& row, std::int64_t voxels, float background, LeafWidth width) {
  if (width == LeafWidth::float32) return true;
  const unsigned exact = exact_bits(row, voxels, background);
  return exact != 0 && (1U << bits_log2_of(width)) >= exact;
}

double bounded_error(const LeafRow& row, std::int64_t voxels, float background, LeafWidth width) {
  if (keeps_every_bit(row, voxels, background, width)) return 0;
  ValueRange range{row.min, row.max, row.mean};
  if (row.finite < voxels) {
    range.min = row.finite == 0 ? background : std::min(range.min, background);
    range.max = row.finite == 0 ? background : std::max(range.max, background);
  }
  if (range.min == range.max) return 0;
  const unsigned bits = 1U << bits_log2_of(width);
  const Quantiser levels = range_quantiser(range, bits);
  const auto quantum = static_cast<double>(levels.quantum);
  const auto magnitude = static_cast<double>(std::max(std::fabs(range.min), std::fabs(range.max)));
  if (quantum == 0) {  // one level: where not all is finite anywhere in the range
    const auto least = static_cast<double>(range.min);
    const auto most = static_cast<double>(range.max);
    const auto level = static_cast<double>(levels.minimum);
    return row.finite < voxels ? most - least
                               : std::max(most - level, level - least) + magnitude * std::ldexp(1.0, -21);
  }
  // A code is found in single precision: near the middle between two levels either may be taken. The product and
  // the sum round, half an ulp each, and the levels' quantum did: half an ulp of it a level.
  const double half = 0.5 + std::ldexp(1.0, static_cast<int>(bits) - 22);
  return quantum * half + magnitude * std::ldexp(1.0, -21);
}

double GainRule::tile_weight(const MinMax& reach, float tile) const {
  MinMax with_tile = reach;
  if (reach.min <= reach.max) widen(with_tile, {tile, tile});
  return visibility->weight(with_tile);
}

GainRule::Weights GainRule::weights_of(const MinMax* reach, float tile) const {
  if (reach == nullptr) return {};
  return {tile_weight(*reach, tile), visibility->weight(*reach)};
}

void GainRule::add_bounded_step(const LeafRow& row, std::int64_t voxels, float tile, const Weights& weights,
                                LeafGain& leaf, RegionGains& out) const {
  const bool seen = weights.tile > 0;
  leaf.required = leaf.required || (seen && row.max_abs_about(tile) > *max_error);
  leaf.lossless = !leaf.required;  // the tile meets the error
  if (!leaf.required) return;
  LeafWidth width = LeafWidth::tile;
  for (const LeafWidth candidate : widths_of(encoding)) {
    width = candidate;
    leaf.lossless = candidate == LeafWidth::float32 || !seen ||
                    bounded_error(row, voxels, fill.background, candidate) <= *max_error;
    if (leaf.lossless) break;
  }
  out.add(leaf, step_to(width, LeafWidth::tile, row.sse_about(tile)));
}

bool GainRule::keys_below(double least_key, const LeafRow& row, float tile, const Weights& weights) const {
  if (!(least_key > std::numeric_limits<double>::denorm_min()) || metric != Metric::sse || max_error) return false;
  // The first step saves no more than all of the error, and takes no less than the least width; others have lower keys,
  // but for roundings.
  constexpr double kRoundings = 1 + 1e-9;
  const auto least_bytes = static_cast<double>(leaf_bytes(LeafWidth::bits1));
  return weights.tile * row.sse_about(tile) / least_bytes * kRoundings < least_key;
}

void GainRule::add_steps(const LeafRow& row, std::int64_t voxels, float tile, const Weights& weights, LeafGain& leaf,
                         RegionGains& out) const {
  if (max_error) return add_bounded_step(row, voxels, tile, weights, leaf, out);
  const bool tile_does = leaf.exact || !(weights.tile > 0);
  leaf.lossless = tile_does;
  if (tile_does && !leaf.required) return;
  const double error = leaf.exact ? 0 : weights.tile * row.sse_about(tile);
  const auto error_at = [&](LeafWidth width) {
    return weights.kept * quantised_error(row, voxels, fill.background, width);
  };
  switch (encoding) {
    case Encoding::automatic:
    case Encoding::float32:
    case Encoding::packed:
      out.add(leaf, step_to(LeafWidth::float32, LeafWidth::tile, error));
      break;
    case Encoding::fp4:
    case Encoding::fp8:
    case Encoding::fp16: {
      const LeafWidth width = widths_of(encoding).front();
      const double gain = std::max(0.0, error - error_at(width));
      if (gain > 0 || leaf.required || keeps_every_bit(row, voxels, fill.background, width)) {
        out.add(leaf, step_to(width, LeafWidth::tile, gain));
      }
      break;
    }
    case Encoding::fpn: {
      const LeafWidth last = widest(row, voxels, fill.background);
      LeafWidth from = LeafWidth::tile;
      double left = error;
      if (leaf.required) {
        from = LeafWidth::bits1;
        left = std::min(error, error_at(from));
        out.add(leaf, step_to(from, LeafWidth::tile, error - left));
      }
      add_hull(error_at, from, left, last, leaf, out);
      // Saves nothing that can be measured, but without it not every bit is kept.
      const LeafWidth reached = last_width(leaf);
      if (!tile_does && reached != last && keeps_every_bit(row, voxels, fill.background, last)) {
        out.add(leaf, step_to(last, reached, 0));
      }
      break;
    }
  }
  if (leaf.step_count > 0) {
    leaf.lossless = leaf.lossless || keeps_every_bit(row, voxels, fill.background, last_width(leaf));
  }
}

void GainRule::gains(const TreeRegions& tree, const RegionRows& rows, RegionGains& out, double least_key) const {
  const NodeLattice& leaves = tree.leaves;
  const std::int64_t side = metric == Metric::sse ? 1 : brick_leaves;
  out.clear();
  const bool whole = are_whole(leaves, rows.leaf_box());
  SharedValues& region = out.shared;
  std::optional<RegionStreams> streams;
  if (packed) {
    region = shared_values(rows, leaves, fill, {max_error, visibility != nullptr});
    streams.emplace(region.means, *packed);
  }
  rows.for_each([&](const Index3& leaf, const LeafRow& row) {
    const std::int64_t voxels = whole ? kLeafVoxels : leaves.voxels(leaf).voxels();
    LeafGain gain;
    gain.position = static_cast<std::uint16_t>(tree.mask_position(leaf));
    gain.brick = brick_of(leaves.first + leaf, side);
    const bool corner = is_corner(leaves, leaf);
    const float tile = packed ? region.value : fill.leaf_value(row);
    gain.exact = fill.exact(row, voxels, tile);
    gain.required = (corner && (!packed || packed->preview)) ||
                    (fill.non_finite == NonFinitePolicy::keep && row.finite < voxels) ||
                    (row.finite == 0 && !gain.exact) ||
                    (!packed && (fill.splits(row.finite, kLeafVoxels) || fill.keeps_active(row)));
    const MinMax* const reach = visibility == nullptr ? nullptr : &rows.reach(leaf);
    out.begin(gain);
    if (packed) {
      add_packed_steps(rows.ladder(leaf), region, *streams, row, voxels, reach, gain, out);
    } else if (const Weights weights = weights_of(reach, tile);
               gain.required || !keys_below(least_key, row, tile, weights)) {
      add_steps(row, voxels, tile, weights, gain, out);
    }
    out.end(gain);
  });
  if (metric != Metric::sse) rank_bricks(rows, out);
}

void GainRule::rank_bricks(const RegionRows& rows, RegionGains& leaves) const {
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
    const double by_brick = gain.exact ? 0 : distance(metric, ranges[gain.brick], fill.background);
    if (gain.step_count > 0) gain.steps[0].gain = gain.steps[0].key = by_brick;
  }
}

}  // namespace weir
