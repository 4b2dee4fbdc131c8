#include "compressor/select/selection.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "compressor/select/cut_search.h"
#include "compressor/select/region_keys.h"
#include "compressor/select/step_keys.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/nanovdb/macrocells.h"

namespace weir {

Selection::Selection(const GainRule& rule, const RowStore& rows, TreeRegions& tree, Search search)
    : rule_(rule), rows_(rows), tree_(tree) {
  struct Totals {
    NodeCounts minimum;
    NodeCounts full;
    std::uint64_t lossy = 0;
  };
  tbb::enumerable_thread_specific<Totals> totals;
  RegionKeys keys(rule_, tree_);
  if (search != Search::no && rows_.team().alone()) begin_holding(search);
  tbb::enumerable_thread_specific<RegionGains> local_gains;
  for_each_own_region(tree_, rows_, [&](std::int64_t region, const RegionRows& region_rows) {
    RegionGains& gains = local_gains.local();
    rule_.gains(tree_, region_rows, gains);
    keys.summarize_region(region, region_rows, gains);
    if (held_ && held_->takes_more()) hold(region, gains);
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
  if (held_ && !held_->complete()) {
    if (held_->takes_more()) counts_ = std::make_unique<KeyCounts>(held_->counts());
    release_steps();
  }
  rows_.team().gather(tree_.regions);
  keys.summarize_uppers();

  std::array<std::uint64_t, 5> sums{};
  for (const Totals& total : totals) {
    sums[0] += total.minimum.leaves;
    sums[1] += total.minimum.leaf_bytes;
    sums[2] += total.full.leaves;
    sums[3] += total.full.leaf_bytes;
    sums[4] += total.lossy;
  }
  rows_.team().sum<std::uint64_t>(sums);
  Purchases minimum{0, 0, sums[0], sums[1]};
  Purchases full{0, 0, sums[2], sums[3]};
  bytes_.lossy_leaves = sums[4];
  for (const Region& region : tree_.regions) {
    minimum.regions += region.key == kRequiredKey ? 1 : 0;
    full.regions += region.key > 0 ? 1 : 0;
  }
  for (const Upper& upper : tree_.uppers) {
    minimum.uppers += upper.key == kRequiredKey ? 1 : 0;
    full.uppers += upper.key > 0 ? 1 : 0;
  }
  bytes_.minimum = layout_of(minimum);
  bytes_.full = layout_of(full);
  required_bytes_ = minimum.uppers * rule_.upper_bytes() + minimum.regions * rule_.region_bytes() + minimum.leaf_bytes;
  bytes_.by_scene = rule_.visibility != nullptr;
}

void Selection::begin_holding(Search search) {
  const double unit = search == Search::of_error ? CutSearch::error_unit(rule_) : 0;
  const bool outside_known = search == Search::of_bytes || unit > 0;
  const KeyRange range = outside_known ? CutSearch::likely_keys(rule_) : CutSearch::every_key();
  std::uint64_t room = rows_.room().step_bytes;
  const std::size_t regions = tree_.regions.size();
  const bool some_above = range.end < CutSearch::every_key().end;
  const std::uint64_t levels = some_above ? regions * LeafChoices::kLeaves : 0;
  const std::uint64_t taken = regions * sizeof(HeldRegion) + levels;
  if (taken <= room / 8) {
    held_regions_.resize(regions);
    if (some_above) levels_ = std::make_unique<PageBuffer>(levels);
    room -= taken;
  }
  held_ = std::make_unique<HeldSteps>(range, room, rule_.region_bytes(), search == Search::of_bytes, unit);
}

void Selection::hold(std::int64_t index, const RegionGains& gains) {
  const auto i = static_cast<std::size_t>(index);
  const Region& region = tree_.regions[i];
  HeldSteps::Part& part = held_->part();
  const std::size_t first = part.size();
  part.add(HeldSteps::Step::opening(index, region.key, region.opening_gain));
  if (region.key != 0) {  // with a region key of 0, no leaf in it has a higher key
    std::byte* const levels = levels_ == nullptr ? nullptr : levels_->bytes().data() + i * LeafChoices::kLeaves;
    const std::uint64_t end = held_->range().end;
    for_each_step(gains, region.key, [&](double key, const LeafGain& leaf, const LeafStep& step) {
      if (levels != nullptr && key_bits(key) >= end) levels[leaf.position] = std::byte{step.level};
      part.add(HeldSteps::Step::of_leaf(index, key, leaf.position, step));
    });
  }
  if (!held_regions_.empty() && held_->complete()) held_regions_[i] = {&part, first, part.size() - first};
}

void Selection::release_steps() {
  held_regions_ = {};
  levels_.reset();
  held_.reset();
}

// Returns the layout of a file with the purchases in `bought`.
TreeLayout Selection::layout_of(const Purchases& bought) const {
  NodeCounts counts;
  counts.root_tiles = tree_.uppers.size();
  counts.macrocells = static_cast<std::uint64_t>(make_lattice(tree_.leaves.domain, kMacrocell).size());
  if (rule_.packed) {
    set_packed_counts(*rule_.packed, tree_, bought.regions, counts);
    counts.packed_bytes += bought.regions * kChunkCost + bought.leaf_bytes;
  } else {
    counts.uppers = bought.uppers;
    counts.lowers = bought.regions;
    counts.leaves = bought.leaves;
    counts.leaf_bytes = bought.leaf_bytes;
  }
  return make_layout(counts);
}

void Selection::resolve_ties(const PurchaseGoal& goal, const Threshold& threshold) {
  cut_.tie_region = static_cast<std::int64_t>(tree_.regions.size());
  PurchaseGoal::Weight bought = threshold.above;
  const auto buy = [&](std::uint64_t bytes, double gain) {
    const PurchaseGoal::Weight weight = goal.weight(bytes, gain);
    if (!goal.admits(bought, weight)) return false;
    bought += weight;
    return true;
  };
  std::vector<std::int64_t> every;
  if (!threshold.tied) {
    every.resize(tree_.regions.size());
    std::iota(every.begin(), every.end(), 0);
  }
  RowBuffers buffers;
  RegionGains gains;
  for (const std::int64_t index : threshold.tied ? *threshold.tied : every) {
    Region& region = tree_.regions[static_cast<std::size_t>(index)];
    if (region.key < cut_.threshold) continue;
    Upper& upper = tree_.uppers[static_cast<std::size_t>(tree_.upper_of(index))];
    const auto stop = [&](std::size_t steps) {
      cut_.tie_region = index;
      cut_.tie_steps = static_cast<std::uint32_t>(steps);
    };
    if (!upper.open) {
      if (!buy(rule_.upper_bytes(), upper.opening_gain)) return stop(0);
      upper.open = true;
    }
    if (!region.open) {
      if (!buy(rule_.region_bytes(), region.opening_gain)) return stop(0);
      region.open = true;
    }
    rule_.gains(tree_, read_region(rows_, tree_.leaf_box(index), buffers), gains);
    const std::vector<LeafPurchase> ties = tied_steps(gains, region.key, cut_.threshold);
    for (std::size_t first = 0; first < ties.size();) {
      std::size_t end = first + 1;  // a brick is bought as a whole
      while (rule_.metric != Metric::sse && end < ties.size() && ties[end].leaf->brick == ties[first].leaf->brick)
        ++end;
      LeafStep all{};
      for (std::size_t i = first; i < end; ++i) {
        all.bytes += ties[i].leaf->steps[ties[i].step].bytes;
        all.gain += ties[i].leaf->steps[ties[i].step].gain;
      }
      if (!buy(all.bytes, all.gain)) return stop(first);
      first = end;
    }
  }
  // Upper nodes remain that save error by themselves, with one tile per region.
  for (Upper& upper : tree_.uppers) {
    if (upper.key == cut_.threshold && !upper.open) upper.open = buy(rule_.upper_bytes(), upper.opening_gain);
    if (upper.key == cut_.threshold && !upper.open) return;
  }
}

void Selection::choose(std::uint64_t file_bytes) {
  if (file_bytes < bytes_.minimum.file_bytes) {
    throw Error(ErrorKind::internal, cat("budget of ", file_bytes, " bytes is below the minimum tree"));
  }
  cut_ = Cut{};
  most_bytes_ = file_bytes;
  if (file_bytes >= bytes_.full.file_bytes) {
    release_steps();
    for (Region& region : tree_.regions) region.open = region.key > 0;
    for (Upper& upper : tree_.uppers) upper.open = upper.key > 0;
    return;
  }
  // Everything that is not bought has the same size in every file of this domain.
  const std::uint64_t fixed = bytes_.minimum.content_end - required_bytes_;
  buy_for({0, file_bytes - fixed});
}

void Selection::choose_error(double squared_error) {
  CompensatedSum all_tiles;
  for (const Upper& upper : tree_.uppers) all_tiles.add(upper.tile_error);
  const double error = all_tiles.value();
  cut_ = Cut{};
  most_bytes_.reset();
  // Every gain is at most the error with nothing bought. That error is 2^84 units or more, so that sums of small gains
  // do not round. If no bound of the error is known beforehand, or a bound far above it, the error is 2^90 units: sums
  // of 2^37 gains fit.
  PurchaseGoal goal;
  goal.unit = CutSearch::error_unit(rule_);
  if (goal.unit == 0 || error < std::ldexp(goal.unit, 84)) goal.unit = std::ldexp(error, -90);
  // If nothing needs to be bought, the search is skipped: sums of gains may round to more than this error, and the
  // difference would be bought.
  if (error <= squared_error) return choose(bytes_.minimum.file_bytes);
  if (!(goal.unit > 0)) return choose(bytes_.full.file_bytes);
  const bool ends_exact = rule_.packed || rule_.encoding == Encoding::float32;
  if (ends_exact) {
    goal.left = goal.weight(0, squared_error);
  } else {
    goal.limit = goal.weight(0, error - squared_error);
  }
  buy_for(goal);
  // For so small an error the sums round. A plan that misses the error is followed by further plans.
  if (squared_error < std::ldexp(error, -40)) most_bytes_.reset();
}

void Selection::buy_for(PurchaseGoal goal) {
  const Threshold threshold = CutSearch(rule_, rows_, tree_, held_.get(), counts_.get()).find_threshold(goal);
  cut_.threshold = threshold.key;
  if (threshold.bytes) {
    Purchases bought;
    for (const Region& region : tree_.regions) bought.regions += region.key > 0 && region.key >= threshold.key ? 1 : 0;
    bought.leaf_bytes = *threshold.bytes - bought.regions * rule_.region_bytes();
    most_bytes_ = layout_of(bought).file_bytes;
  }
  for (Region& region : tree_.regions) region.open = region.key > cut_.threshold;
  for (Upper& upper : tree_.uppers) upper.open = upper.key > cut_.threshold;
  Team& team = rows_.team();
  team.lead([&] { resolve_ties(goal, threshold); });
  team.follow(tree_.regions);
  team.follow(tree_.uppers);
  team.follow(cut_);
}

std::optional<Selection::PreviewedBytes> Selection::previewed_bytes() const {
  if (!most_bytes_) return std::nullopt;
  Purchases opened;
  for (const Region& region : tree_.regions) opened.regions += region.open ? 1 : 0;
  return PreviewedBytes{*most_bytes_, layout_of(opened).node_bytes()};
}

std::optional<LeafChoices> Selection::held_choices(std::int64_t index) const {
  if (held_regions_.empty() || !held_->range().holds(cut_.threshold)) return std::nullopt;
  const auto i = static_cast<std::size_t>(index);
  const HeldRegion& held = held_regions_[i];
  LeafChoices choices;
  if (levels_ != nullptr) {
    const std::span<const std::byte> levels = levels_->bytes().subspan(i * LeafChoices::kLeaves, LeafChoices::kLeaves);
    for (std::size_t position = 0; position < levels.size(); ++position) {
      choices.set(position, static_cast<KeptLevel>(levels[position]));
    }
  }
  bool tied = false;
  held.part->for_each(held.first, held.count, [&](const HeldSteps::Step& step) {
    if (step.opens()) return;
    tied = tied || step.key == cut_.threshold;
    if (step.key > cut_.threshold) choices.set(step.position(), step.level());
  });
  // The order of purchases decides ties, and the held steps alone do not tell it.
  if (tied && index <= cut_.tie_region) return std::nullopt;
  return choices;
}

LeafChoices Selection::choices(std::int64_t index, const RegionRows& rows, RegionGains& gains) const {
  LeafChoices choices;
  const Region& region = tree_.regions[static_cast<std::size_t>(index)];
  if (!region.open) return choices;
  if (const std::optional<LeafChoices> held = held_choices(index)) return *held;
  rule_.gains(tree_, rows, gains, cut_.threshold);
  for (const LeafGain& leaf : gains) {
    // Keys fall from step to step: the last step above the cut decides the width.
    for (std::uint32_t i = 0; i < leaf.step_count && step_key(leaf, i, region.key) > cut_.threshold; ++i) {
      choices.set(leaf.position, leaf.steps[i].level);
    }
  }
  if (cut_.threshold == 0 || index > cut_.tie_region) return choices;
  std::vector<LeafPurchase> ties = tied_steps(gains, region.key, cut_.threshold);
  if (index == cut_.tie_region) ties.resize(std::min<std::size_t>(ties.size(), cut_.tie_steps));
  for (const LeafPurchase& tie : ties) choices.set(tie.leaf->position, tie.leaf->steps[tie.step].level);
  return choices;
}

}  // namespace weir
