#include "compressor/selection.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "format/error.h"
#include "format/macrocells.h"
#include "format/text.h"

namespace weir {
namespace {

constexpr double kRequired = std::numeric_limits<double>::infinity();
// Saves nothing that can be measured, but without it not every bit is kept: bought last.
constexpr double kLast = std::numeric_limits<double>::denorm_min();
constexpr auto kLeafCost = static_cast<double>(nvdb::kFloatLeafBytes);
constexpr auto kLowerCost = static_cast<double>(nvdb::kLowerBytes);
constexpr auto kUpperCost = static_cast<double>(nvdb::kUpperBytes);

double leaf_key(const GainRule& rule, const LeafGain& leaf, double region_key) {
  if (leaf.required) return kRequired;
  if (leaf.exact) return 0;
  const double own = rule.metric == Metric::sse ? leaf.gain / kLeafCost : leaf.gain;
  return std::max(kLast, std::min(own, region_key));
}

// The best ratio of saved error to bytes over opening a region and keeping its k best leaves.
double hull_step(double opening_gain, std::vector<double>& gains) {
  std::sort(gains.begin(), gains.end(), std::greater<>());
  double saved = opening_gain;
  double cost = kLowerCost;
  double best = saved / cost;
  for (const double gain : gains) {
    saved += gain;
    cost += kLeafCost;
    best = std::max(best, saved / cost);
  }
  return best;
}

// Among leaves of equal keys: more gain first, then whole bricks, then the leaf index.
bool goes_before(const LeafGain& a, const LeafGain& b) {
  if (a.gain != b.gain) return a.gain > b.gain;
  return a.brick < b.brick;
}

// Keys are not negative, so that their bits sort as they do.
std::uint64_t bits_of(double key) { return std::bit_cast<std::uint64_t>(key); }

}  // namespace

Selection::Selection(const GainRule& rule, const RowStore& rows, TreeRegions& tree)
    : rule_(rule), rows_(rows), tree_(tree) {
  struct Totals {
    std::uint64_t required_leaves = 0;
    std::uint64_t lossless_leaves = 0;
  };
  tbb::enumerable_thread_specific<Totals> totals;
  for_each_region(tree_, rows_, [&](std::int64_t region, const RegionRows& region_rows) {
    std::vector<LeafGain> gains;
    rule_.gains(tree_, region_rows, gains);
    summarize_region(region, region_rows, gains);
    Totals& total = totals.local();
    for (const LeafGain& leaf : gains) {
      total.required_leaves += leaf.required ? 1 : 0;
      total.lossless_leaves += leaf.required || !leaf.exact ? 1 : 0;
    }
  });
  summarize_uppers();

  NodeCounts minimum;
  NodeCounts lossless;
  for (const Totals& total : totals) {
    minimum.leaves += total.required_leaves;
    lossless.leaves += total.lossless_leaves;
  }
  for (const Region& region : tree_.regions) {
    minimum.lowers += region.key == kRequired ? 1 : 0;
    lossless.lowers += region.key > 0 ? 1 : 0;
  }
  for (const Upper& upper : tree_.uppers) {
    minimum.uppers += upper.key == kRequired ? 1 : 0;
    lossless.uppers += upper.key > 0 ? 1 : 0;
  }
  for (NodeCounts* counts : {&minimum, &lossless}) {
    counts->root_tiles = tree_.uppers.size();
    counts->leaf_bytes = counts->leaves * nvdb::kFloatLeafBytes;
    counts->macrocells = static_cast<std::uint64_t>(make_lattice(tree_.leaves.domain, kMacrocell).size());
  }
  bytes_.minimum = make_layout(minimum);
  bytes_.lossless = make_layout(lossless);
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

  std::vector<double> values;
  bool required = false;
  double highest = 0;
  for (const LeafGain& leaf : gains) {
    required = required || leaf.required;
    highest = std::max(highest, leaf.gain);
    if (!leaf.exact) values.push_back(leaf.gain);
  }
  if (required) {
    region.key = kRequired;
  } else if (exact) {
    region.key = 0;
  } else if (rule_.metric == Metric::sse) {
    region.key = std::max(kLast, hull_step(std::max(0.0, region.sums.sse_about(tile) - dropped_leaves), values));
  } else {
    region.key = std::max(kLast, highest);
  }
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
    double tiles = 0;  // squared error with one tile per region
    tree_.for_each_region_of(i, [&](std::int64_t r) {
      const Region& region = tree_.regions[static_cast<std::size_t>(r)];
      const TileSums& sums = region.sums;
      const float region_tile = tile_value(rule_.fill, sums);
      builder.add_squares(sums.finite, static_cast<double>(sums.mean), sums.residual, sums.sse);
      exact = exact && sums.exact && bits_of(static_cast<double>(region_tile)) == bits_of(static_cast<double>(tile));
      tiles += sums.sse_about(region_tile);
      upper.key = std::max(upper.key, region.key);
    });
    upper.sums = builder.sums;
    upper.sums.exact = exact;
    if (exact) continue;
    const double saved = std::max(0.0, upper.sums.sse_about(tile) - tiles);
    upper.key = std::max({upper.key, kLast, rule_.metric == Metric::sse ? saved / kUpperCost : 0.0});
  }
}

// Calls visit(key, bytes) for everything below the upper nodes that can be bought.
template <typename Visit>
void Selection::for_each_key(const Visit& visit) const {
  for_each_region(tree_, rows_, [&](std::int64_t index, const RegionRows& rows) {
    const Region& region = tree_.regions[static_cast<std::size_t>(index)];
    visit(region.key, nvdb::kLowerBytes);
    if (region.key == 0) return;  // no leaf in it has a higher one
    std::vector<LeafGain> gains;
    rule_.gains(tree_, rows, gains);
    for (const LeafGain& leaf : gains) visit(leaf_key(rule_, leaf, region.key), nvdb::kFloatLeafBytes);
  });
}

double Selection::find_threshold(std::uint64_t budget, std::uint64_t& bytes_above) const {
  // Radix selection from the top: 16 bits of the keys a pass, bytes counted per bucket, until the bucket
  // that the budget ends in is small enough to be sorted.
  constexpr int kDigit = 16;
  constexpr std::size_t kBuckets = std::size_t{1} << kDigit;
  constexpr std::uint64_t kSortedItems = std::uint64_t{1} << 16U;  // of 16 bytes
  struct Bucket {
    std::uint64_t bytes = 0;
    std::uint64_t items = 0;
  };
  using Buckets = std::vector<Bucket>;
  std::uint64_t prefix = 0;
  bytes_above = 0;
  for (int shift = 64 - kDigit; shift >= 0; shift -= kDigit) {
    const auto matches = [&](double key, int bits) {
      return key > 0 && (bits == 64 || bits_of(key) >> bits == prefix);
    };
    tbb::enumerable_thread_specific<Buckets> local(kBuckets);
    const auto count = [&](Buckets& buckets, double key, std::uint64_t bytes) {
      if (!matches(key, shift + kDigit)) return;
      Bucket& bucket = buckets[bits_of(key) >> shift & (kBuckets - 1)];
      bucket.bytes += bytes;
      ++bucket.items;
    };
    for_each_key([&](double key, std::uint64_t bytes) { count(local.local(), key, bytes); });
    Buckets total(kBuckets);
    for (const Buckets& buckets : local) {
      for (std::size_t i = 0; i < kBuckets; ++i) {
        total[i].bytes += buckets[i].bytes;
        total[i].items += buckets[i].items;
      }
    }
    for (const Upper& upper : tree_.uppers) count(total, upper.key, nvdb::kUpperBytes);
    std::size_t bucket = kBuckets;
    while (bucket > 0 && bytes_above + total[bucket - 1].bytes <= budget) bytes_above += total[--bucket].bytes;
    if (bucket == 0) return 0;  // everything fits
    prefix = prefix << kDigit | (bucket - 1);
    if (shift == 0) break;
    if (total[bucket - 1].items <= kSortedItems) {
      return sorted_threshold(budget, bytes_above, [&](double key) { return matches(key, shift); });
    }
  }
  return std::bit_cast<double>(prefix);
}

double Selection::sorted_threshold(std::uint64_t budget, std::uint64_t& bytes_above,
                                   const std::function<bool(double)>& matches) const {
  using Item = std::pair<double, std::uint64_t>;  // key, bytes
  tbb::enumerable_thread_specific<std::vector<Item>> local;
  for_each_key([&](double key, std::uint64_t bytes) {
    if (matches(key)) local.local().emplace_back(key, bytes);
  });
  std::vector<Item> items;
  for (const std::vector<Item>& some : local) items.insert(items.end(), some.begin(), some.end());
  for (const Upper& upper : tree_.uppers) {
    if (matches(upper.key)) items.emplace_back(upper.key, nvdb::kUpperBytes);
  }
  std::sort(items.begin(), items.end(), std::greater<>());
  for (std::size_t i = 0; i < items.size();) {
    const double key = items[i].first;
    std::uint64_t bytes = 0;
    for (; i < items.size() && items[i].first == key; ++i) bytes += items[i].second;
    if (bytes_above + bytes > budget) return key;
    bytes_above += bytes;
  }
  throw Error(ErrorKind::internal, "the selection's cut lies in no bucket");
}

void Selection::resolve_ties(std::uint64_t left) {
  cut_.tie_region = static_cast<std::int64_t>(tree_.regions.size());
  const auto buy = [&](std::uint64_t bytes) {
    if (bytes > left) return false;
    left -= bytes;
    return true;
  };
  std::vector<LeafRow> row_buffer;
  std::vector<LeafGain> gains;
  for (std::int64_t index = 0; index < static_cast<std::int64_t>(tree_.regions.size()); ++index) {
    Region& region = tree_.regions[static_cast<std::size_t>(index)];
    if (region.key < cut_.threshold) continue;
    Upper& upper = tree_.uppers[static_cast<std::size_t>(tree_.upper_of(index))];
    const auto stop = [&](std::uint32_t leaves) {
      cut_.tie_region = index;
      cut_.tie_leaves = leaves;
    };
    if (!upper.open) {
      if (!buy(nvdb::kUpperBytes)) return stop(0);
      upper.open = true;
    }
    if (!region.open) {
      if (!buy(nvdb::kLowerBytes)) return stop(0);
      region.open = true;
    }
    const Box box = tree_.leaf_box(index);
    rows_.read_box(box, row_buffer);
    rule_.gains(tree_, RegionRows(row_buffer.data(), box.extent(), box), gains);
    std::erase_if(gains, [&](const LeafGain& leaf) { return leaf_key(rule_, leaf, region.key) != cut_.threshold; });
    std::stable_sort(gains.begin(), gains.end(), goes_before);
    for (std::size_t first = 0; first < gains.size();) {
      std::size_t end = first + 1;  // a brick goes as one
      while (end < gains.size() && gains[end].brick == gains[first].brick) ++end;
      if (!buy((end - first) * nvdb::kFloatLeafBytes)) return stop(static_cast<std::uint32_t>(first));
      first = end;
    }
  }
  // What is left are upper nodes that save error by themselves, with one tile per region.
  for (Upper& upper : tree_.uppers) {
    if (upper.key == cut_.threshold && !upper.open) upper.open = buy(nvdb::kUpperBytes);
    if (upper.key == cut_.threshold && !upper.open) return;
  }
}

void Selection::choose(std::uint64_t file_bytes) {
  if (file_bytes < bytes_.minimum.file_bytes) {
    throw Error(ErrorKind::internal, cat("budget of ", file_bytes, " bytes is below the minimum tree"));
  }
  cut_ = Cut{};
  if (file_bytes >= bytes_.lossless.file_bytes) {
    for (Region& region : tree_.regions) region.open = region.key > 0;
    for (Upper& upper : tree_.uppers) upper.open = upper.key > 0;
    return;
  }
  // Everything but nodes and leaves has the same size in every file of this domain.
  const NodeCounts& minimum = bytes_.minimum.counts;
  const std::uint64_t nodes =
      minimum.uppers * nvdb::kUpperBytes + minimum.lowers * nvdb::kLowerBytes + minimum.leaf_bytes;
  const std::uint64_t fixed = bytes_.minimum.content_end - nodes;
  const std::uint64_t budget = file_bytes - fixed;
  std::uint64_t above = 0;
  cut_.threshold = find_threshold(budget, above);
  for (Region& region : tree_.regions) region.open = region.key > cut_.threshold;
  for (Upper& upper : tree_.uppers) upper.open = upper.key > cut_.threshold;
  resolve_ties(budget - above);
}

LeafMask Selection::mask(std::int64_t index, const RegionRows& rows) const {
  LeafMask mask;
  const Region& region = tree_.regions[static_cast<std::size_t>(index)];
  if (!region.open) return mask;
  std::vector<LeafGain> gains;
  rule_.gains(tree_, rows, gains);
  std::vector<LeafGain> ties;
  for (const LeafGain& leaf : gains) {
    const double key = leaf_key(rule_, leaf, region.key);
    if (key > cut_.threshold) {
      mask.set(leaf.position);
    } else if (key == cut_.threshold && key > 0 && index <= cut_.tie_region) {
      ties.push_back(leaf);
    }
  }
  std::stable_sort(ties.begin(), ties.end(), goes_before);
  if (index == cut_.tie_region) ties.resize(std::min<std::size_t>(ties.size(), cut_.tie_leaves));
  for (const LeafGain& leaf : ties) mask.set(leaf.position);
  return mask;
}

}  // namespace weir
