#include "compressor/outlook/budget_outlook.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "compressor/outlook/sampled_steps.h"
#include "compressor/packed/block_sample.h"
#include "compressor/packed/ladder_builder.h"
#include "compressor/select/fixed_bytes.h"
#include "format/layout/nanovdb_layout.h"
#include "format/leaf/bounds.h"

namespace weir {
namespace {

/// The sampled blocks whose values are all finite.
struct Sample {
  struct Leaf {
    std::size_t row;     // of the sample
    std::size_t region;  // of `regions`
    std::int64_t linear;
    std::int64_t voxels;
    LeafRow found;
  };
  struct RegionPart {
    std::int64_t index;    // in the lattice of regions
    std::int64_t sampled;  // sampled blocks of the region, with any values
  };
  std::vector<Leaf> leaves;  // without blocks of one value
  std::vector<RegionPart> regions;
  std::int64_t count = 0;  // blocks, with those of one value
  std::int64_t left_out = 0;
  std::uint64_t voxels = 0;
  std::size_t rows = 0;
  MinMax range = kNoBounds;
};

/// Numbers the regions that are sampled.
class RegionNumbers {
 public:
  RegionNumbers(const NodeLattice& leaves, std::vector<Sample::RegionPart>& regions)
      : leaves_(leaves), lattice_(make_lattice(leaves.domain, kLowerDim)), regions_(regions) {}

  /// Counts the leaf as a block of its region, and returns the region's number.
  std::size_t add(const Index3& leaf) {
    const std::int64_t index = lattice_.linear(floor_div(leaves_.first + leaf, kLowerLeaves) - lattice_.first);
    if (regions_.empty() || regions_[last_].index != index) {  // otherwise the region is the last leaf's
      const auto [found, is_new] = numbers_.try_emplace(index, regions_.size());
      if (is_new) regions_.push_back({index, 0});
      last_ = found->second;
    }
    ++regions_[last_].sampled;
    return last_;
  }

 private:
  const NodeLattice& leaves_;
  NodeLattice lattice_;
  std::vector<Sample::RegionPart>& regions_;
  std::map<std::int64_t, std::size_t> numbers_;
  std::size_t last_ = 0;
};

Sample read_sample(const RowStore& rows) {
  const NodeLattice& leaves = rows.leaves();
  Sample sample;
  RegionNumbers regions(leaves, sample.regions);
  std::vector<LeafRow> found;
  for (const Box& box : BlockSample(leaves).rows()) {
    rows.read_box(box, found);
    for (std::int64_t i = 0; i < box.voxels(); ++i) {
      const Index3 leaf = box.lo + index_at(i, box.extent());
      const LeafRow& row = found[static_cast<std::size_t>(i)];
      const std::int64_t voxels = leaves.voxels(leaf).voxels();
      const std::size_t region = regions.add(leaf);
      if (row.finite < voxels) {
        ++sample.left_out;
        continue;
      }
      ++sample.count;
      sample.voxels += static_cast<std::uint64_t>(voxels);
      widen(sample.range, {row.min, row.max});
      if (!row.uniform()) sample.leaves.push_back({sample.rows, region, leaves.linear(leaf), voxels, row});
    }
    ++sample.rows;
  }
  return sample;
}

constexpr std::size_t kLeavesTogether = 128;  // by one thread

SampledSteps::Part steps_of(std::span<const Sample::Leaf> leaves, const GainRule& rule, const RegionStreams& streams,
                            const MeanRange& range, const RowStore& rows) {
  SampledSteps::Part steps;
  RegionGains gains;
  for (const Sample::Leaf& sampled : leaves) {
    PackedLadder ladder;
    rows.ladders()->read(sampled.linear, std::span(&ladder, 1));
    MinMax reach;
    if (rule.visibility != nullptr) rows.reaches()->read(sampled.linear, std::span(&reach, 1));
    // The block is treated as alone in its region: its mean is the value of blocks without a stream.
    const SharedValues region{sampled.found.mean, range};
    LeafGain leaf;
    gains.clear();
    gains.begin(leaf);
    rule.add_packed_steps(ladder, region, streams, sampled.found, sampled.voxels,
                          rule.visibility == nullptr ? nullptr : &reach, leaf, gains);
    const SampledBlock block{sampled.row, sampled.region, is_sparse(sampled.found), ladder.exact == ExactKind::ordered};
    for (const LeafStep& step : leaf.all_steps()) steps.add(block, step);
  }
  return steps;
}

SampledSteps steps_of(const Sample& sample, const GainRule& rule, const MeanRange& range, const RowStore& rows) {
  const RegionStreams streams(range, *rule.packed);
  std::vector<SampledSteps::Part> parts((sample.leaves.size() + kLeavesTogether - 1) / kLeavesTogether);
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
    const std::size_t first = kLeavesTogether * part;
    const std::size_t count = std::min(kLeavesTogether, sample.leaves.size() - first);
    parts[part] = steps_of(std::span(sample.leaves).subspan(first, count), rule, streams, range, rows);
  });
  return {range.high - range.low, sample.rows, std::move(parts)};
}

// Bytes of the lower nodes of a file that keeps the steps of `key` and higher ones: of regions that pay for theirs, as
// far as their samples tell, by the share of those that were sampled.
double preview_bytes(const SampledSteps& steps, const Sample& sample, const NodeLattice& leaves, double key) {
  constexpr auto kNodeBytes = static_cast<double>(nvdb::kLowerBytes);
  struct Sums {
    double gain = 0;
    double bytes = 0;
  };
  std::vector<Sums> sums(sample.regions.size());
  steps.for_each_from(key, [&](std::size_t region, double gain, double bytes) {
    sums[region].gain += gain;
    sums[region].bytes += bytes;
  });
  const NodeLattice lattice = make_lattice(leaves.domain, kLowerDim);
  std::size_t open = 0;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const Sample::RegionPart& region = sample.regions[i];
    const double blocks = static_cast<double>(lattice.voxels(lattice.position(region.index)).voxels()) / kLeafVoxels;
    const double scale = blocks / static_cast<double>(region.sampled);
    if (sums[i].gain * scale >= key * (kNodeBytes + sums[i].bytes * scale) && sums[i].gain > 0) ++open;
  }
  const double share = static_cast<double>(open) / static_cast<double>(sums.size());
  return static_cast<double>(lattice.size()) * share * kNodeBytes;
}

BudgetOutlook judge(const FileRequest& request, const RowStore& rows) {
  const Sample sample = read_sample(rows);
  if (sample.count == 0) return {NearBlocks::all, std::nullopt};  // nothing to judge by
  const MeanRange range{sample.range.min, sample.range.max};
  GainRule rule = request.rule;
  rule.packed = PackedRule{false, coarsest_step(range.low, range.high)};
  const SampledSteps steps = steps_of(sample, rule, range, rows);
  const double share = static_cast<double>(sample.count) / static_cast<double>(rows.leaves().size());
  const Budget& budget = request.budget;
  BudgetOutlook outlook;
  if (budget.kind == Budget::Kind::psnr) {
    const double width = static_cast<double>(range.high) - static_cast<double>(range.low);
    const double error = width * width * static_cast<double>(sample.voxels) / std::pow(10, budget.target / 10);
    if (const auto bought = steps.within_error(error)) {
      constexpr double kClearly = 2;
      outlook.near = bought->near;
      outlook.window = bought->window;
      outlook.short_of_preview = kClearly * bought->bytes / share <
                                 kLeastOfPreview * preview_bytes(steps, sample, rows.leaves(), bought->least_key);
    }
  } else {
    const std::uint64_t dense = float32_bytes(request.domain);
    const std::uint64_t asked = asked_bytes(budget, dense);
    const std::uint64_t fixed =
        fixed_bytes(request.domain, Encoding::packed, request.packed.preview, asked, region_count(request.domain));
    const SampledCut bought =
        steps.within_bytes(std::max(0.0, static_cast<double>(asked) - static_cast<double>(fixed)) * share);
    outlook.near = bought.near;
    outlook.window = bought.window;
    // The bytes of blocks with values that are not finite are not known, so the window gets its full reach.
    if (outlook.window && sample.left_out > 0)
      outlook.window.emplace(outlook.window->centre(), outlook.window->width());
  }
  if (rule.visibility != nullptr || rows.leaves().size() < kLeastForecastBlocks) {
    outlook.window.reset();
    outlook.short_of_preview = false;
  }
  return outlook;
}

}  // namespace

BudgetOutlook outlook_of(const FileRequest& request, const RowStore& rows) {
  BudgetOutlook outlook;
  rows.team().lead([&] { outlook = judge(request, rows); });
  rows.team().follow(outlook);
  return outlook;
}

}  // namespace weir
