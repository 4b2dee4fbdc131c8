#include "compressor/select/selection.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/nanovdb/macrocells.h"

namespace weir {
namespace {

constexpr double kRequired = std::numeric_limits<double>::infinity();
// Saves nothing that can be measured, but without it not every bit is kept: bought last.
constexpr double kLast = std::numeric_limits<double>::denorm_min();
constexpr auto kLowerCost = static_cast<double>(nvdb::kLowerBytes);
constexpr auto kUpperCost = static_cast<double>(nvdb::kUpperBytes);

// Key of step `i` of a leaf in a region of `region_key`: never above it, and falling from step to step.
double step_key(const LeafGain& leaf, std::uint32_t i, double region_key) {
  if (leaf.required && i == 0) return kRequired;
  return std::max(kLast, std::min(leaf.steps[i].key, region_key));
}

// One step of one leaf.
struct Item {
  const LeafGain* leaf;
  std::uint32_t step;
};

// The best ratio of saved error to bytes over opening a region and taking the k best steps of its leaves.
double hull_step(double opening_gain, std::vector<LeafStep>& steps) {
  // Equal keys in any order: the best ratio is at the end of a run of them.
  std::sort(steps.begin(), steps.end(), [](const LeafStep& a, const LeafStep& b) { return a.key > b.key; });
  double saved = opening_gain;
  double cost = kLowerCost;
  double best = saved / cost;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    saved += steps[i].gain;
    cost += static_cast<double>(steps[i].bytes);
    if (i + 1 == steps.size() || steps[i + 1].key != steps[i].key) best = std::max(best, saved / cost);
  }
  return best;
}

// Among steps of equal keys: the higher own key first, which is a leaf's earlier step too, then whole bricks, then
// the leaf index.
bool goes_before(const Item& a, const Item& b) {
  const double of_a = a.leaf->steps[a.step].key;
  const double of_b = b.leaf->steps[b.step].key;
  if (of_a != of_b) return of_a > of_b;
  if (a.leaf->brick != b.leaf->brick) return a.leaf->brick < b.leaf->brick;
  return a.leaf == b.leaf && a.step < b.step;
}

// The steps of a region's leaves whose key is `threshold`, in the order they are bought.
std::vector<Item> tied_steps(const std::vector<LeafGain>& gains, double region_key, double threshold) {
  std::vector<Item> ties;
  for (const LeafGain& leaf : gains) {
    for (std::uint32_t i = 0; i < leaf.step_count; ++i) {
      if (step_key(leaf, i, region_key) == threshold) ties.push_back({&leaf, i});
    }
  }
  std::stable_sort(ties.begin(), ties.end(), goes_before);
  return ties;
}

// Keys are not negative, so that their bits sort as they do.
std::uint64_t bits_of(double key) { return std::bit_cast<std::uint64_t>(key); }

}  // namespace

Selection::Selection(const GainRule& rule, const RowStore& rows, TreeRegions& tree)
    : rule_(rule), rows_(rows), tree_(tree) {
  struct Totals {
    NodeCounts minimum;
    NodeCounts full;
    std::uint64_t lossy = 0;
  };
  tbb::enumerable_thread_specific<Totals> totals;
  for_each_own_region(tree_, rows_, [&](std::int64_t region, const RegionRows& region_rows) {
    std::vector<LeafGain> gains;
    rule_.gains(tree_, region_rows, gains);
    summarize_region(region, region_rows, gains);
    Totals& total = totals.local();
    for (const LeafGain& leaf : gains) {
      total.lossy += leaf.lossless ? 0 : 1;
      if (leaf.step_count == 0) continue;
      ++total.full.leaves;
      for (std::uint32_t i = 0; i < leaf.step_count; ++i) total.full.leaf_bytes += leaf.steps[i].bytes;
      if (!leaf.required) continue;
      ++total.minimum.leaves;
      total.minimum.leaf_bytes += leaf.steps[0].bytes;
    }
  });
  rows_.team().gather(tree_.regions);
  summarize_uppers();

  std::array<std::uint64_t, 5> sums{};
  for (const Totals& total : totals) {
    sums[0] += total.minimum.leaves;
    sums[1] += total.minimum.leaf_bytes;
    sums[2] += total.full.leaves;
    sums[3] += total.full.leaf_bytes;
    sums[4] += total.lossy;
  }
  rows_.team().sum<std::uint64_t>(sums);
  NodeCounts minimum;
  NodeCounts full;
  minimum.leaves = sums[0];
  minimum.leaf_bytes = sums[1];
  full.leaves = sums[2];
  full.leaf_bytes = sums[3];
  bytes_.lossy_leaves = sums[4];
  for (const Region& region : tree_.regions) {
    minimum.lowers += region.key == kRequired ? 1 : 0;
    full.lowers += region.key > 0 ? 1 : 0;
  }
  for (const Upper& upper : tree_.uppers) {
    minimum.uppers += upper.key == kRequired ? 1 : 0;
    full.uppers += upper.key > 0 ? 1 : 0;
  }
  for (NodeCounts* counts : {&minimum, &full}) {
    counts->root_tiles = tree_.uppers.size();
    counts->macrocells = static_cast<std::uint64_t>(make_lattice(tree_.leaves.domain, kMacrocell).size());
  }
  bytes_.minimum = make_layout(minimum);
  bytes_.full = make_layout(full);
  bytes_.by_scene = rule_.visibility != nullptr;
}

void Selection::summarize_region(std::int64_t index, const RegionRows& rows, const std::vector<LeafGain>& gains) {
  Region& region = tree_.regions[static_cast<std::size_t>(index)];
  TileSumsBuilder builder;
  rows.for_each([&](const Index3&, const LeafRow& row) {
    builder.add_mean(row.finite, static_cast<double>(row.mean), static_cast<double>(row.residual), row.min, row.max);
  });
  builder.close_mean(rule_.fill.background);
  // A region of one value keeps its very bits: a mean of -0.0 would be +0.0.
  const LeafRow& first = rows.at(rows.leaf_box().lo);
  if (first.uniform() && builder.sums.min == builder.sums.max) builder.sums.mean = first.mean;
  const float tile = tile_value(rule_.fill, builder.sums);
  bool exact = true;
  double dropped_leaves = 0;  // squared error once the region is open and before any leaf is kept
  rows.for_each([&](const Index3& leaf, const LeafRow& row) {
    builder.add_squares(row.finite, static_cast<double>(row.mean), static_cast<double>(row.residual), row.sse);
    exact = exact && rule_.fill.exact(row, tree_.leaves.voxels(leaf).voxels(), tile);
    dropped_leaves += row.sse_about(rule_.fill.leaf_value(row));
  });
  region.sums = builder.sums;
  region.sums.exact = exact;
  region.tile_error = region.sums.sse_about(tile);
  if (rule_.visibility != nullptr) dropped_leaves = weigh_region(region, rows, tile);
  region.opening_gain = std::max(0.0, region.tile_error - dropped_leaves);

  std::vector<LeafStep> steps;
  bool required = false;
  double highest = 0;
  for (const LeafGain& leaf : gains) {
    required = required || leaf.required;
    highest = std::max(highest, leaf.steps[0].gain);
    steps.insert(steps.end(), leaf.steps.begin(), leaf.steps.begin() + leaf.step_count);
  }
  if (required || (rule_.max_error && exceeds(*rule_.max_error, region, tile))) {
    region.key = kRequired;
  } else if (exact || rule_.max_error || !sees(region, tile)) {
    region.key = 0;
  } else if (rule_.metric == Metric::sse) {
    region.key = std::max(kLast, hull_step(region.opening_gain, steps));
  } else {
    region.key = std::max(kLast, highest);
  }
}

// The weighted errors of a region: sets that of its one tile, returns that of its leaves' tiles.
double Selection::weigh_region(Region& region, const RegionRows& rows, float tile) const {
  region.tile_error = 0;
  double dropped_leaves = 0;
  rows.for_each([&](const Index3& leaf, const LeafRow& row) {
    const MinMax& reach = rows.reach(leaf);
    widen(region.reach, reach);
    region.tile_error += rule_.tile_weight(reach, tile) * row.sse_about(tile);
    const float leaf_tile = rule_.fill.leaf_value(row);
    dropped_leaves += rule_.tile_weight(reach, leaf_tile) * row.sse_about(leaf_tile);
  });
  return dropped_leaves;
}

// Whether anything of a region that reads `tile` can be seen.
bool Selection::sees(const Region& region, float tile) const {
  return rule_.visibility == nullptr || rule_.tile_weight(region.reach, tile) > 0;
}

bool Selection::exceeds(double max_error, const Region& region, float tile) const {
  return sees(region, tile) && region.sums.max_abs_about(tile) > max_error;
}

void Selection::summarize_uppers() {
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(tree_.uppers.size()); ++i) {
    Upper& upper = tree_.uppers[static_cast<std::size_t>(i)];
    TileSumsBuilder builder;
    const auto sums_of = [&](std::int64_t r) -> const TileSums& {
      return tree_.regions[static_cast<std::size_t>(r)].sums;
    };
    const TileSums* first = nullptr;
    tree_.for_each_region_of(i, [&](std::int64_t r) {
      const TileSums& sums = sums_of(r);
      first = first == nullptr ? &sums : first;
      builder.add_mean(sums.finite, static_cast<double>(sums.mean), sums.residual, sums.min, sums.max);
    });
    builder.close_mean(rule_.fill.background);
    if (first->exact && builder.sums.min == builder.sums.max) builder.sums.mean = first->mean;
    const float tile = tile_value(rule_.fill, builder.sums);
    bool exact = true;
    double tiles = 0;     // squared error with one tile per region
    double weighted = 0;  // and with one for all, where a scene weighs
    bool seen = false;
    bool exceeded = false;
    tree_.for_each_region_of(i, [&](std::int64_t r) {
      const Region& region = tree_.regions[static_cast<std::size_t>(r)];
      const TileSums& sums = region.sums;
      const float region_tile = tile_value(rule_.fill, sums);
      builder.add_squares(sums.finite, static_cast<double>(sums.mean), sums.residual, sums.sse);
      exact = exact && sums.exact && bits_of(static_cast<double>(region_tile)) == bits_of(static_cast<double>(tile));
      tiles += rule_.visibility == nullptr ? sums.sse_about(region_tile) : region.tile_error;
      upper.key = std::max(upper.key, region.key);
      seen = seen || sees(region, tile);
      exceeded = exceeded || (rule_.max_error && exceeds(*rule_.max_error, region, tile));
      if (rule_.visibility != nullptr) weighted += rule_.tile_weight(region.reach, tile) * sums.sse_about(tile);
    });
    upper.sums = builder.sums;
    upper.sums.exact = exact;
    upper.tile_error = rule_.visibility == nullptr ? upper.sums.sse_about(tile) : std::max(weighted, tiles);
    if (exact || !seen) continue;
    if (rule_.max_error) {
      if (exceeded) upper.key = kRequired;
      continue;
    }
    upper.opening_gain = std::max(0.0, upper.tile_error - tiles);
    upper.key = std::max({upper.key, kLast, rule_.metric == Metric::sse ? upper.opening_gain / kUpperCost : 0.0});
  }
}

// Calls visit(key, bytes, gain) for everything below the upper nodes that can be bought.
template <typename Visit>
void Selection::for_each_key(const Visit& visit) const {
  for_each_own_region(tree_, rows_, [&](std::int64_t index, const RegionRows& rows) {
    const Region& region = tree_.regions[static_cast<std::size_t>(index)];
    visit(region.key, nvdb::kLowerBytes, region.opening_gain);
    if (region.key == 0) return;  // no leaf in it has a higher one
    std::vector<LeafGain> gains;
    rule_.gains(tree_, rows, gains);
    for (const LeafGain& leaf : gains) {
      for (std::uint32_t i = 0; i < leaf.step_count; ++i) {
        visit(step_key(leaf, i, region.key), leaf.steps[i].bytes, leaf.steps[i].gain);
      }
    }
  });
}

Selection::Goal::Weight Selection::Goal::weight(std::uint64_t bytes, double gain) const {
  return unit == 0 ? Weight{bytes} : static_cast<Weight>(std::max(0.0, gain) / unit);
}

double Selection::find_threshold(const Goal& goal, Goal::Weight& above) const {
  // Radix selection from the top: 16 bits of the keys a pass, weights counted per bucket, until the bucket
  // that the goal is reached in is small enough to be sorted.
  constexpr int kDigit = 16;
  constexpr std::size_t kBuckets = std::size_t{1} << kDigit;
  constexpr std::uint64_t kSortedItems = std::uint64_t{1} << 15U;  // of 32 bytes
  struct Bucket {
    Goal::Weight weight = 0;
    std::uint64_t items = 0;
    void operator+=(const Bucket& other) {
      weight += other.weight;
      items += other.items;
    }
  };
  using Buckets = std::vector<Bucket>;
  std::uint64_t prefix = 0;
  above = 0;
  for (int shift = 64 - kDigit; shift >= 0; shift -= kDigit) {
    // What is required is bought whatever the goal.
    const auto matches = [&](double key, int bits) {
      return key > 0 && key != kRequired && (bits == 64 || bits_of(key) >> bits == prefix);
    };
    tbb::enumerable_thread_specific<Buckets> local(kBuckets);
    tbb::enumerable_thread_specific<Goal::Weight> required(0);
    const auto count = [&](Buckets& buckets, double key, Goal::Weight weight) {
      if (key == kRequired) required.local() += weight;
      if (!matches(key, shift + kDigit)) return;
      Bucket& bucket = buckets[bits_of(key) >> shift & (kBuckets - 1)];
      bucket.weight += weight;
      ++bucket.items;
    };
    for_each_key(
        [&](double key, std::uint64_t bytes, double gain) { count(local.local(), key, goal.weight(bytes, gain)); });
    Buckets total(kBuckets);
    for (const Buckets& buckets : local) {
      for (std::size_t i = 0; i < kBuckets; ++i) total[i] += buckets[i];
    }
    rows_.team().sum<Bucket>(total);
    Goal::Weight all_required = required.combine(std::plus<>());
    rows_.team().sum<Goal::Weight>({&all_required, 1});
    required.clear();
    for (const Upper& upper : tree_.uppers) {
      count(total, upper.key, goal.weight(nvdb::kUpperBytes, upper.opening_gain));
    }
    if (prefix == 0 && shift == 64 - kDigit) {
      above += all_required + required.combine(std::plus<>());
      if (goal.unit != 0 && above >= goal.limit) return std::numeric_limits<double>::max();
    }
    std::size_t bucket = kBuckets;
    while (bucket > 0 && goal.admits_all(above, total[bucket - 1].weight)) above += total[--bucket].weight;
    if (bucket == 0) return 0;  // everything may be bought
    prefix = prefix << kDigit | (bucket - 1);
    if (shift == 0) break;
    if (total[bucket - 1].items <= kSortedItems) {
      return sorted_threshold(goal, above, [&](double key) { return matches(key, shift); });
    }
  }
  return std::bit_cast<double>(prefix);
}

double Selection::sorted_threshold(const Goal& goal, Goal::Weight& above,
                                   const std::function<bool(double)>& matches) const {
  struct Purchase {
    double key;
    Goal::Weight weight;
  };
  tbb::enumerable_thread_specific<std::vector<Purchase>> local;
  for_each_key([&](double key, std::uint64_t bytes, double gain) {
    if (matches(key)) local.local().push_back({key, goal.weight(bytes, gain)});
  });
  std::vector<Purchase> items;
  for (const std::vector<Purchase>& some : local) items.insert(items.end(), some.begin(), some.end());
  rows_.team().concatenate(items);
  for (const Upper& upper : tree_.uppers) {
    if (matches(upper.key)) items.push_back({upper.key, goal.weight(nvdb::kUpperBytes, upper.opening_gain)});
  }
  std::sort(items.begin(), items.end(), [](const Purchase& a, const Purchase& b) { return a.key > b.key; });
  for (std::size_t i = 0; i < items.size();) {
    const double key = items[i].key;
    Goal::Weight weight = 0;
    for (; i < items.size() && items[i].key == key; ++i) weight += items[i].weight;
    if (!goal.admits_all(above, weight)) return key;
    above += weight;
  }
  throw Error(ErrorKind::internal, "the selection's cut lies in no bucket");
}

void Selection::resolve_ties(const Goal& goal, Goal::Weight bought) {
  cut_.tie_region = static_cast<std::int64_t>(tree_.regions.size());
  const auto buy = [&](std::uint64_t bytes, double gain) {
    const Goal::Weight weight = goal.weight(bytes, gain);
    if (!goal.admits(bought, weight)) return false;
    bought += weight;
    return true;
  };
  RowBuffers buffers;
  std::vector<LeafGain> gains;
  for (std::int64_t index = 0; index < static_cast<std::int64_t>(tree_.regions.size()); ++index) {
    Region& region = tree_.regions[static_cast<std::size_t>(index)];
    if (region.key < cut_.threshold) continue;
    Upper& upper = tree_.uppers[static_cast<std::size_t>(tree_.upper_of(index))];
    const auto stop = [&](std::size_t steps) {
      cut_.tie_region = index;
      cut_.tie_steps = static_cast<std::uint32_t>(steps);
    };
    if (!upper.open) {
      if (!buy(nvdb::kUpperBytes, upper.opening_gain)) return stop(0);
      upper.open = true;
    }
    if (!region.open) {
      if (!buy(nvdb::kLowerBytes, region.opening_gain)) return stop(0);
      region.open = true;
    }
    rule_.gains(tree_, read_region(rows_, tree_.leaf_box(index), buffers), gains);
    const std::vector<Item> ties = tied_steps(gains, region.key, cut_.threshold);
    for (std::size_t first = 0; first < ties.size();) {
      std::size_t end = first + 1;  // a brick goes as one
      while (rule_.metric != Metric::sse && end < ties.size() && ties[end].leaf->brick == ties[first].leaf->brick)
        ++end;
      LeafStep all;
      for (std::size_t i = first; i < end; ++i) {
        all.bytes += ties[i].leaf->steps[ties[i].step].bytes;
        all.gain += ties[i].leaf->steps[ties[i].step].gain;
      }
      if (!buy(all.bytes, all.gain)) return stop(first);
      first = end;
    }
  }
  // What is left are upper nodes that save error by themselves, with one tile per region.
  for (Upper& upper : tree_.uppers) {
    if (upper.key == cut_.threshold && !upper.open) upper.open = buy(nvdb::kUpperBytes, upper.opening_gain);
    if (upper.key == cut_.threshold && !upper.open) return;
  }
}

void Selection::choose(std::uint64_t file_bytes) {
  if (file_bytes < bytes_.minimum.file_bytes) {
    throw Error(ErrorKind::internal, cat("budget of ", file_bytes, " bytes is below the minimum tree"));
  }
  cut_ = Cut{};
  if (file_bytes >= bytes_.full.file_bytes) {
    for (Region& region : tree_.regions) region.open = region.key > 0;
    for (Upper& upper : tree_.uppers) upper.open = upper.key > 0;
    return;
  }
  // Everything but nodes and leaves has the same size in every file of this domain.
  const NodeCounts& minimum = bytes_.minimum.counts;
  const std::uint64_t nodes =
      minimum.uppers * nvdb::kUpperBytes + minimum.lowers * nvdb::kLowerBytes + minimum.leaf_bytes;
  const std::uint64_t fixed = bytes_.minimum.content_end - nodes;
  buy_for({0, file_bytes - fixed});
}

void Selection::choose_error(double squared_error) {
  CompensatedSum all_tiles;
  for (const Upper& upper : tree_.uppers) all_tiles.add(upper.tile_error);
  const double error = all_tiles.value();
  cut_ = Cut{};
  // Every gain is at most the error of nothing bought, which becomes 2^90: sums of 2^37 gains fit, and each is
  // counted to 2^-90 of it.
  Goal goal;
  goal.unit = std::ldexp(error, -90);
  if (!(goal.unit > 0)) return choose(error > squared_error ? bytes_.full.file_bytes : bytes_.minimum.file_bytes);
  goal.limit = goal.weight(0, error - squared_error);
  buy_for(goal);
}

void Selection::buy_for(const Goal& goal) {
  Goal::Weight above = 0;
  cut_.threshold = find_threshold(goal, above);
  for (Region& region : tree_.regions) region.open = region.key > cut_.threshold;
  for (Upper& upper : tree_.uppers) upper.open = upper.key > cut_.threshold;
  Team& team = rows_.team();
  team.lead([&] { resolve_ties(goal, above); });
  team.follow(tree_.regions);
  team.follow(tree_.uppers);
  team.follow(cut_);
}

LeafChoices Selection::choices(std::int64_t index, const RegionRows& rows) const {
  LeafChoices choices;
  const Region& region = tree_.regions[static_cast<std::size_t>(index)];
  if (!region.open) return choices;
  std::vector<LeafGain> gains;
  rule_.gains(tree_, rows, gains);
  for (const LeafGain& leaf : gains) {
    // Keys fall from step to step: the last one above the cut is the width.
    for (std::uint32_t i = 0; i < leaf.step_count && step_key(leaf, i, region.key) > cut_.threshold; ++i) {
      choices.set(leaf.position, leaf.steps[i].width);
    }
  }
  if (cut_.threshold == 0 || index > cut_.tie_region) return choices;
  std::vector<Item> ties = tied_steps(gains, region.key, cut_.threshold);
  if (index == cut_.tie_region) ties.resize(std::min<std::size_t>(ties.size(), cut_.tie_steps));
  for (const Item& tie : ties) choices.set(tie.leaf->position, tie.leaf->steps[tie.step].width);
  return choices;
}

}  // namespace weir
