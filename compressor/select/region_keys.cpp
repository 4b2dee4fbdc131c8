#include "compressor/select/region_keys.h"

#include <algorithm>

#include "compressor/select/step_keys.h"
#include "format/layout/nanovdb_layout.h"

namespace weir {
namespace {

// Returns the best ratio of saved error to bytes of opening a region and taking the k best steps of its leaves. The
// best steps are all steps with a higher ratio of their own. For any given ratio, opening and the steps above that
// ratio together reach at most the best ratio. So each pass drops the steps that the last pass took too many of, until
// none is left to drop (Dinkelbach 1967): four or five passes. The keys of each leaf's steps fall.
double hull_step(double opening_gain, std::uint64_t opening_bytes, const RegionGains& gains) {
  const auto ratio_with = [&](const auto& takes) {
    double saved = opening_gain;
    std::uint64_t cost = opening_bytes;
    for (const LeafGain& leaf : gains) {
      for (const LeafStep& step : leaf.all_steps()) {
        if (!takes(leaf, step)) break;
        saved += step.gain;
        cost += step.bytes;
      }
    }
    return saved / static_cast<double>(cost);
  };
  double best = ratio_with([](const LeafGain& leaf, const LeafStep& step) { return &step == leaf.steps; });
  for (;;) {
    const double ratio = ratio_with([best](const LeafGain&, const LeafStep& step) { return step.key > best; });
    if (!(ratio > best)) return best;
    best = ratio;
  }
}

}  // namespace

void RegionKeys::summarize_region(std::int64_t index, const RegionRows& rows, const RegionGains& gains) {
  Region& region = tree_.regions[static_cast<std::size_t>(index)];
  TileSumsBuilder builder;
  rows.for_each([&](const Index3&, const LeafRow& row) {
    builder.add_mean(row.finite, static_cast<double>(row.mean), static_cast<double>(row.residual), row.min, row.max);
    builder.sums.zeros += row.zeros;
    builder.sums.valued = builder.sums.valued || row.valued();
  });
  builder.close_mean(rule_.fill.background);
  // A region of one value keeps that value's bits: a computed mean of -0.0 would be +0.0.
  const LeafRow& first = rows.at(rows.leaf_box().lo);
  if (first.uniform() && builder.sums.min == builder.sums.max) builder.sums.mean = first.mean;
  // Packed blocks without a stream, and regions without streams, read one shared value.
  const std::optional<float> shared_value = rule_.packed ? std::optional(gains.shared.value) : std::nullopt;
  const float tile = shared_value ? *shared_value : tile_value(rule_.fill, builder.sums);
  region.packed_value = tile;
  if (shared_value) region.packed_means = gains.shared.means;
  const auto dropped_value = [&](const LeafRow& row) {
    return shared_value ? *shared_value : rule_.fill.leaf_value(row);
  };
  const bool whole = are_whole(tree_.leaves, rows.leaf_box());
  bool exact = true;
  bool keeps_values = true;
  double dropped_leaves = 0;  // squared error once the region is open and before any leaf is kept
  rows.for_each([&](const Index3& leaf, const LeafRow& row) {
    builder.add_squares(row.finite, static_cast<double>(row.mean), static_cast<double>(row.residual), row.sse);
    exact = exact && rule_.fill.exact(row, whole ? kLeafVoxels : tree_.leaves.voxels(leaf).voxels(), tile);
    keeps_values = keeps_values && Fill::keeps_values(row, tile);
    dropped_leaves += row.sse_about(dropped_value(row));
  });
  region.sums = builder.sums;
  region.sums.exact = exact;
  region.sums.keeps_values = keeps_values;
  region.tile_error = region.sums.sse_about(tile);
  if (rule_.visibility != nullptr) dropped_leaves = weigh_region(region, rows, tile, shared_value);
  region.opening_gain = std::max(0.0, region.tile_error - dropped_leaves);

  bool required = !rule_.packed && rule_.fill.splits(region.sums.finite, kLowerDim * kLowerDim * kLowerDim);
  double highest = 0;
  for (const LeafGain& leaf : gains) {
    required = required || leaf.required;
    highest = std::max(highest, leaf.first_gain());
  }
  if (required || (rule_.max_error && exceeds(*rule_.max_error, region, tile))) {
    region.key = kRequiredKey;
  } else if (exact || rule_.max_error || !sees(region, tile)) {
    region.key = 0;
  } else if (rule_.metric == Metric::sse) {
    region.key = std::max(kLastKey, hull_step(region.opening_gain, rule_.region_bytes(), gains));
  } else {
    region.key = std::max(kLastKey, highest);
  }
}

// Sets the region's weighted error as one tile, and returns the weighted error of its leaves' tiles.
double RegionKeys::weigh_region(Region& region, const RegionRows& rows, float tile,
                                std::optional<float> shared_value) const {
  region.tile_error = 0;
  double dropped_leaves = 0;
  rows.for_each([&](const Index3& leaf, const LeafRow& row) {
    const MinMax& reach = rows.reach(leaf);
    widen(region.reach, reach);
    region.tile_error += rule_.tile_weight(reach, tile) * row.sse_about(tile);
    const float leaf_tile = shared_value ? *shared_value : rule_.fill.leaf_value(row);
    dropped_leaves += rule_.tile_weight(reach, leaf_tile) * row.sse_about(leaf_tile);
  });
  return dropped_leaves;
}

// Returns whether anything of a region that reads `tile` can be seen.
bool RegionKeys::sees(const Region& region, float tile) const {
  return rule_.visibility == nullptr || rule_.tile_weight(region.reach, tile) > 0;
}

bool RegionKeys::exceeds(double max_error, const Region& region, float tile) const {
  return sees(region, tile) && region.sums.max_abs_about(tile) > max_error;
}

void RegionKeys::summarize_uppers() {
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(tree_.uppers.size()); ++i) summarize_upper(i);
}

void RegionKeys::summarize_upper(std::int64_t index) {
  Upper& upper = tree_.uppers[static_cast<std::size_t>(index)];
  TileSumsBuilder builder = sums_to_mean(index);
  const float tile = tile_value(rule_.fill, builder.sums);
  builder.sums.exact = builder.sums.keeps_values = true;
  double tiles = 0;     // squared error with one tile per region
  double weighted = 0;  // squared error with one tile for all regions, if a scene weighs
  bool seen = false;
  bool exceeded = false;
  tree_.for_each_region_of(index, [&](std::int64_t r) {
    const Region& region = tree_.regions[static_cast<std::size_t>(r)];
    const TileSums& sums = region.sums;
    const float region_tile = tile_value(rule_.fill, sums);
    builder.add_squares(sums.finite, static_cast<double>(sums.mean), sums.residual, sums.sse);
    const bool same = Fill::same_bits(region_tile, tile);
    builder.sums.exact = builder.sums.exact && sums.exact && same;
    builder.sums.keeps_values = builder.sums.keeps_values && (sums.finite == 0 || (sums.keeps_values && same));
    tiles += rule_.visibility == nullptr && !rule_.packed ? sums.sse_about(region_tile) : region.tile_error;
    upper.key = std::max(upper.key, region.key);
    seen = seen || sees(region, tile);
    exceeded = exceeded || (rule_.max_error && exceeds(*rule_.max_error, region, tile));
    if (rule_.visibility != nullptr) weighted += rule_.tile_weight(region.reach, tile) * sums.sse_about(tile);
  });
  upper.sums = builder.sums;
  if (rule_.packed) {
    upper.tile_error = tiles;
    upper.key = kRequiredKey;  // costs nothing here: the tree's bytes are the same in every file
    return;
  }
  upper.tile_error = rule_.visibility == nullptr ? upper.sums.sse_about(tile) : std::max(weighted, tiles);
  set_key(upper, tiles, seen, exceeded);
}

// Returns counts, bounds and mean over an upper node's regions, in a builder to which the squares can be added.
TileSumsBuilder RegionKeys::sums_to_mean(std::int64_t upper) const {
  TileSumsBuilder builder;
  const TileSums* first = nullptr;
  tree_.for_each_region_of(upper, [&](std::int64_t r) {
    const TileSums& sums = tree_.regions[static_cast<std::size_t>(r)].sums;
    first = first == nullptr ? &sums : first;
    builder.add_mean(sums.finite, static_cast<double>(sums.mean), sums.residual, sums.min, sums.max);
    builder.sums.zeros += sums.zeros;
    builder.sums.valued = builder.sums.valued || sums.valued;
  });
  builder.close_mean(rule_.fill.background);
  if (first->exact && builder.sums.min == builder.sums.max) builder.sums.mean = first->mean;
  return builder;
}

// Sets key and opening gain of an upper node. Its key so far is the highest key of its regions. `tiles`: its squared
// error with one tile per region. `seen`: its one tile can be seen somewhere. `exceeded`: its one tile exceeds the
// rule's largest error somewhere.
void RegionKeys::set_key(Upper& upper, double tiles, bool seen, bool exceeded) const {
  const double opening_gain = std::max(0.0, upper.tile_error - tiles);
  if (rule_.fill.splits(upper.sums.finite, kUpperDim * kUpperDim * kUpperDim)) {
    upper.key = kRequiredKey;
    upper.opening_gain = opening_gain;
    return;
  }
  if (upper.sums.exact || !seen) return;
  if (rule_.max_error) {
    if (exceeded) upper.key = kRequiredKey;
    return;
  }
  upper.opening_gain = opening_gain;
  upper.key =
      std::max({upper.key, kLastKey,
                rule_.metric == Metric::sse ? upper.opening_gain / static_cast<double>(rule_.upper_bytes()) : 0.0});
}

}  // namespace weir
