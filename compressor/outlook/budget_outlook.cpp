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

/// The steps of sampled blocks by the regions that these lie in: which regions have a lower node.
class SampledRegions {
 public:
  explicit SampledRegions(const NodeLattice& leaves)
      : leaves_(leaves), lattice_(make_lattice(leaves.domain, kLowerDim)) {
    for (const Box& box : BlockSample(leaves).rows()) {
      for (std::int64_t i = 0; i < box.voxels(); ++i) ++regions_[region_of(box.lo + index_at(i, box.extent()))].sampled;
    }
  }
  /// `leaf` is a linear index.
  void add(std::int64_t leaf, const LeafStep& step) {
    steps_.push_back({region_of(leaves_.position(leaf)), step.key, step.gain, static_cast<double>(step.bytes)});
  }
  /// How many regions of the volume pay for a node of `node_bytes` by their steps of `key` or a higher one, as far as
  /// their samples tell, by the share of those that were sampled.
  double open(double key, double node_bytes) const {
    std::map<std::int64_t, Sums> sums = regions_;
    for (const Step& step : steps_) {
      if (!(step.key >= key)) continue;
      Sums& of_region = sums[step.region];
      of_region.gain += step.gain;
      of_region.bytes += step.bytes;
    }
    std::size_t open = 0;
    for (const auto& [region, found] : sums) {
      const double blocks = static_cast<double>(lattice_.voxels(lattice_.position(region)).voxels()) / kLeafVoxels;
      const double scale = blocks / static_cast<double>(found.sampled);
      if (found.gain * scale >= key * (node_bytes + found.bytes * scale) && found.gain > 0) ++open;
    }
    return static_cast<double>(lattice_.size()) * static_cast<double>(open) / static_cast<double>(sums.size());
  }

 private:
  struct Sums {
    std::int64_t sampled = 0;
    double gain = 0;
    double bytes = 0;
  };
  struct Step {
    std::int64_t region;
    double key;
    double gain;
    double bytes;
  };
  std::int64_t region_of(const Index3& leaf) const {
    return lattice_.linear(floor_div(leaves_.first + leaf, kLowerLeaves) - lattice_.first);
  }

  const NodeLattice& leaves_;
  NodeLattice lattice_;
  std::map<std::int64_t, Sums> regions_;
  std::vector<Step> steps_;
};

/// The sampled blocks whose values are all finite.
struct Sample {
  struct Leaf {
    std::size_t sampled_row;
    std::int64_t linear;
    std::int64_t voxels;
    LeafRow row;
  };
  std::vector<Leaf> leaves;  // but for those of one value
  std::int64_t count = 0;    // those too
  std::int64_t left_out = 0;
  std::uint64_t voxels = 0;
  std::size_t rows = 0;
  MinMax range = kNoBounds;
};

Sample read_sample(const RowStore& rows) {
  const NodeLattice& leaves = rows.leaves();
  Sample sample;
  std::vector<LeafRow> found;
  for (const Box& box : BlockSample(leaves).rows()) {
    rows.read_box(box, found);
    for (std::int64_t i = 0; i < box.voxels(); ++i) {
      const Index3 leaf = box.lo + index_at(i, box.extent());
      const LeafRow& row = found[static_cast<std::size_t>(i)];
      const std::int64_t voxels = leaves.voxels(leaf).voxels();
      if (row.finite < voxels) {
        ++sample.left_out;
        continue;
      }
      ++sample.count;
      sample.voxels += static_cast<std::uint64_t>(voxels);
      widen(sample.range, {row.min, row.max});
      if (!row.uniform()) sample.leaves.push_back({sample.rows, leaves.linear(leaf), voxels, row});
    }
    ++sample.rows;
  }
  return sample;
}

struct StepOfLeaf {
  const Sample::Leaf* leaf;
  bool ordered;  // its exact kind is that of floats in order
  LeafStep step;
};
using StepsOfLeaves = std::vector<StepOfLeaf>;
constexpr std::size_t kLeavesTogether = 128;  // by one thread

StepsOfLeaves steps_of(std::span<const Sample::Leaf> leaves, const GainRule& rule, const StreamLengths& lengths,
                       const MeanRange& range, const RowStore& rows) {
  StepsOfLeaves steps;
  RegionGains gains;
  for (const Sample::Leaf& sampled : leaves) {
    PackedLadder ladder;
    rows.ladders()->read(sampled.linear, std::span(&ladder, 1));
    MinMax reach;
    if (rule.visibility != nullptr) rows.reaches()->read(sampled.linear, std::span(&reach, 1));
    // Alone in its region, its mean the value of blocks without a stream.
    const SharedValues region{sampled.row.mean, range};
    LeafGain leaf;
    gains.clear();
    gains.begin(leaf);
    rule.add_packed_steps(ladder, region, lengths, sampled.row, sampled.voxels,
                          rule.visibility == nullptr ? nullptr : &reach, leaf, gains);
    for (const LeafStep& step : leaf.all_steps()) steps.push_back({&sampled, ladder.exact == ExactKind::ordered, step});
  }
  return steps;
}

std::vector<StepsOfLeaves> steps_of(const Sample& sample, const GainRule& rule, const MeanRange& range,
                                    const RowStore& rows) {
  const StreamLengths lengths(range, *rule.packed);
  std::vector<StepsOfLeaves> steps((sample.leaves.size() + kLeavesTogether - 1) / kLeavesTogether);
  tbb::parallel_for(std::size_t{0}, steps.size(), [&](std::size_t part) {
    const std::size_t first = kLeavesTogether * part;
    const std::size_t count = std::min(kLeavesTogether, sample.leaves.size() - first);
    steps[part] = steps_of(std::span(sample.leaves).subspan(first, count), rule, lengths, range, rows);
  });
  return steps;
}

// Bytes of the lower nodes of a file that keeps the steps of `key` and higher ones. Frees the steps.
double preview_bytes(std::vector<StepsOfLeaves>& steps, const NodeLattice& leaves, double key) {
  constexpr auto kNodeBytes = static_cast<double>(nvdb::kLowerBytes);
  SampledRegions regions(leaves);
  for (StepsOfLeaves& part : steps) {
    for (const StepOfLeaf& of_leaf : std::exchange(part, {})) regions.add(of_leaf.leaf->linear, of_leaf.step);
  }
  return regions.open(key, kNodeBytes) * kNodeBytes;
}

BudgetOutlook judge(const FileRequest& request, const RowStore& rows) {
  const Sample sample = read_sample(rows);
  if (sample.count == 0) return {NearBlocks::all, std::nullopt};  // nothing to judge by
  const MeanRange range{sample.range.min, sample.range.max};
  GainRule rule = request.rule;
  rule.packed = PackedRule{false, coarsest_step(range.low, range.high)};
  std::vector<StepsOfLeaves> found = steps_of(sample, rule, range, rows);
  SampledSteps steps(range.high - range.low, sample.rows);
  for (const StepsOfLeaves& part : found) {
    for (const auto& [leaf, ordered, step] : part) {
      steps.add({leaf->sampled_row, is_sparse(leaf->row), ordered}, step);
    }
  }
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
      outlook.short_of_preview =
          kClearly * bought->bytes / share < kLeastOfPreview * preview_bytes(found, rows.leaves(), bought->least_key);
    }
  } else {
    const auto dense = static_cast<std::uint64_t>(request.domain.voxels()) * sizeof(float);
    const std::uint64_t asked = asked_bytes(budget, dense);
    const std::uint64_t fixed =
        fixed_bytes(request.domain, Encoding::packed, request.packed.preview, asked, region_count(request.domain));
    const SampledCut bought =
        steps.within_bytes(std::max(0.0, static_cast<double>(asked) - static_cast<double>(fixed)) * share);
    outlook.near = bought.near;
    outlook.window = bought.window;
    // What blocks with values that are not finite take is not known.
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
