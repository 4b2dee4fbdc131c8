#include "compressor/select/budget_outlook.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <vector>

#include "compressor/packed/block_sample.h"
#include "compressor/packed/ladder_builder.h"
#include "compressor/select/fixed_bytes.h"
#include "compressor/select/step_keys.h"
#include "format/layout/nanovdb_layout.h"
#include "format/leaf/bounds.h"

namespace weir {
namespace {

/// Bytes of streams, and of those that are near rungs or floats in order, of sparse blocks and of others.
struct BoughtBytes {
  double all = 0;
  double near_sparse = 0;
  double near_other = 0;

  void add(const BoughtBytes& bytes) {
    all += bytes.all;
    near_sparse += bytes.near_sparse;
    near_other += bytes.near_other;
  }
  NearBlocks near() const {
    // Fewer are not worth their time; with a fiftieth by other blocks, a file takes 5 % fewer bytes.
    const double least = all / 256;
    if (near_other > least) return NearBlocks::all;
    return near_sparse > least ? NearBlocks::sparse : NearBlocks::none;
  }
};

/// The bytes that each row of a sample takes, as by a sample of so many rows: how far off that is.
class RowSpread {
 public:
  explicit RowSpread(std::size_t rows) : bytes_(rows) {}
  void add(std::size_t row, double bytes) { bytes_[row] += bytes; }
  /// Standard deviation of the sum. By the differences of neighbours: each row stands for its own part of the volume.
  double deviation() const {
    if (bytes_.size() < 2) return std::numeric_limits<double>::infinity();
    double squares = 0;
    for (std::size_t i = 1; i < bytes_.size(); ++i) squares += std::pow(bytes_[i] - bytes_[i - 1], 2);
    const auto rows = static_cast<double>(bytes_.size());
    return std::sqrt(squares / 2 * rows / (rows - 1));
  }

 private:
  std::vector<double> bytes_;
};

/// The steps of the blocks of a sample of so many rows, counted by their keys. The blocks' values lie in a range of
/// that width.
class SampledSteps {
 public:
  SampledSteps(float width, std::size_t rows) : width_(width), rows_(rows) {}
  /// A step of a block in that row of the sample.
  void add(std::size_t sampled_row, const LeafRow& row, const PackedLadder& ladder, const LeafStep& step) {
    const std::uint64_t at = key_bits(step.key) >> kDropped;
    Bucket& bucket = buckets_[at];
    const auto bytes = static_cast<double>(step.bytes);
    bucket.bytes.all += bytes;
    bucket.gain += step.gain;
    steps_.push_back({static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(sampled_row), bytes});
    const bool exact = step.level == kExactLevel;
    if (!(exact ? ladder.exact == ExactKind::ordered : step.level >= kFirstNearLevel)) return;
    (is_sparse(row) ? bucket.bytes.near_sparse : bucket.bytes.near_other) += bytes;
  }

  /// Of what is bought for so many bytes.
  BudgetOutlook within_bytes(double bytes) const {
    BoughtBytes bought;
    std::size_t cut = buckets_.size();
    while (cut > 0 && bought.all <= bytes) bought.add(buckets_[--cut].bytes);
    if (bought.all <= bytes) return {bought.near(), std::nullopt};
    return {bought.near(), KeyWindow::about(key_of(cut), width_, reach_at(cut, bytes))};
  }

  struct OfError {
    BudgetOutlook outlook;
    double bytes;      ///< of what is bought
    double least_key;  ///< that it has, about
  };
  /// Of what must be bought so that no more than that error is left; nullopt where nothing must.
  std::optional<OfError> within_error(double squared_error) const {
    double left = 0;
    for (std::size_t cut = 0; cut < buckets_.size(); ++cut) {
      left += buckets_[cut].gain;
      if (left <= squared_error) continue;
      BoughtBytes bought;
      for (std::size_t i = cut; i < buckets_.size(); ++i) bought.add(buckets_[i].bytes);
      return OfError{{bought.near(), KeyWindow::about(key_of(cut), width_)}, bought.all, key_of(cut)};
    }
    return std::nullopt;
  }

 private:
  struct Bucket {
    BoughtBytes bytes{};
    double gain = 0;
  };
  static constexpr int kDropped = 48;  // bits of a key: 16 to an octave remain

  static double key_of(std::size_t bucket) {
    return std::bit_cast<double>(static_cast<std::uint64_t>(bucket) << kDropped);
  }
  // How far from the key of bucket `cut`, at which so many bytes are bought, the cut of the volume may lie.
  double reach_at(std::size_t cut, double bytes) const {
    constexpr double kDeviations = 3;
    constexpr double kLeast = 1.25;  // lower nodes, and steps of one key, move the cut a little
    constexpr double kBeside = 1.15;
    RowSpread spread(rows_);
    for (const Step& step : steps_) {
      if (step.bucket >= cut) spread.add(step.row, step.bytes);
    }
    const double off = kDeviations * spread.deviation();
    if (!(off < bytes)) return KeyWindow::kMostReach;
    double bought = 0;
    std::size_t bucket = buckets_.size();
    const auto key_at = [&](double most) {
      while (bucket > 0 && bought <= most) bought += buckets_[--bucket].bytes.all;
      return bought > most ? key_of(bucket) : 0;
    };
    const double high = key_at(bytes - off);
    const double low = key_at(bytes + off);
    const double reach = std::max(high / key_of(cut), key_of(cut) / low);
    return std::clamp(kBeside * reach, kLeast, KeyWindow::kMostReach);
  }

  struct Step {
    std::uint32_t bucket;
    std::uint32_t row;
    double bytes;
  };

  float width_;
  std::size_t rows_;
  std::vector<Step> steps_;
  std::vector<Bucket> buckets_ = std::vector<Bucket>(std::size_t{1} << (64 - kDropped));
};

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
      if (row.finite < voxels) continue;
      ++sample.count;
      sample.voxels += static_cast<std::uint64_t>(voxels);
      widen(sample.range, {row.min, row.max});
      if (!row.uniform()) sample.leaves.push_back({sample.rows, leaves.linear(leaf), voxels, row});
    }
    ++sample.rows;
  }
  return sample;
}

BudgetOutlook judge(const FileRequest& request, const RowStore& rows) {
  const Sample sample = read_sample(rows);
  if (sample.count == 0) return {NearBlocks::all, std::nullopt};  // nothing to judge by
  const MeanRange range{sample.range.min, sample.range.max};
  GainRule rule = request.rule;
  rule.packed = PackedRule{false, coarsest_step(range.low, range.high)};
  const StreamLengths lengths(range, *rule.packed);
  SampledSteps steps(range.high - range.low, sample.rows);
  SampledRegions regions(rows.leaves());
  RegionGains gains;
  for (const Sample::Leaf& sampled : sample.leaves) {
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
    for (const LeafStep& step : leaf.all_steps()) {
      steps.add(sampled.sampled_row, sampled.row, ladder, step);
      regions.add(sampled.linear, step);
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
      constexpr auto kNodeBytes = static_cast<double>(nvdb::kLowerBytes);
      const double preview = regions.open(bought->least_key, kNodeBytes) * kNodeBytes;
      outlook = bought->outlook;
      outlook.short_of_preview = kClearly * bought->bytes / share < kLeastOfPreview * preview;
    }
  } else {
    const auto dense = static_cast<std::uint64_t>(request.domain.voxels()) * sizeof(float);
    const std::uint64_t asked = asked_bytes(budget, dense);
    const std::uint64_t fixed =
        fixed_bytes(request.domain, Encoding::packed, request.packed.preview, asked, region_count(request.domain));
    outlook = steps.within_bytes(std::max(0.0, static_cast<double>(asked) - static_cast<double>(fixed)) * share);
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
