#include "compressor/select/packed_region.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>
#include <vector>

#include "compressor/leaf/certificate.h"
#include "format/packed/block_encode.h"
#include "format/packed/lattice_block.h"

namespace weir {
namespace {

// Squared error of a block's mean by step, from the least one on: its codes lie the step's size / sqrt(512) apart.
const std::array<double, kMostStep - kLeastStep + 1> kMeanErrors = [] {
  std::array<double, kMostStep - kLeastStep + 1> errors{};
  for (std::int32_t step = kLeastStep; step <= kMostStep; ++step) {
    const auto size = static_cast<double>(step_size(step));
    errors[static_cast<std::size_t>(step - kLeastStep)] = size * size / 12;
  }
  return errors;
}();

// A block without a finite value counts as whole.
std::uint64_t voxels_of(const LeafRow& row) { return row.finite == 0 ? std::uint64_t{kLeafVoxels} : row.finite; }

// Returns whether every voxel of the block is read as `value`, to the bit, if the block has no stream and the region's
// blocks without a stream read `value`.
bool reads_exactly(const LeafRow& row, float value, const Fill& fill) {
  if (row.finite == 0) return fill.non_finite != NonFinitePolicy::keep && Fill::same_bits(fill.background, value);
  return Fill::keeps_values(row, value);
}

struct RegionSums {
  std::uint64_t voxels = 0;            // by voxels_of()
  float mean = 0;                      // of the finite voxels; the background if there are none
  std::vector<std::uint32_t> uniform;  // the bits of each uniform block's value
};

RegionSums sum_region(const RegionRows& rows, const Fill& fill) {
  RegionSums sums;
  CompensatedSum sum;
  std::uint64_t finite = 0;
  rows.for_each([&](const Index3&, const LeafRow& row) {
    sums.voxels += voxels_of(row);
    sum.add(static_cast<double>(row.mean) * row.finite);
    finite += row.finite;
    if (row.uniform()) sums.uniform.push_back(std::bit_cast<std::uint32_t>(row.mean));
    if (row.finite == 0 && fill.non_finite != NonFinitePolicy::keep) {
      sums.uniform.push_back(std::bit_cast<std::uint32_t>(fill.background));
    }
  });
  sums.mean = finite == 0 ? fill.background : static_cast<float>(sum.value() / static_cast<double>(finite));
  return sums;
}

// Returns the value that most uniform blocks have. If several are equally frequent, the one of the lowest bits wins.
std::optional<float> commonest(std::vector<std::uint32_t> values) {
  if (values.empty()) return std::nullopt;
  if (std::ranges::all_of(values, [&](std::uint32_t value) { return value == values.front(); })) {
    return std::bit_cast<float>(values.front());
  }
  std::sort(values.begin(), values.end());
  std::size_t best = 0;
  std::size_t most = 0;
  for (std::size_t first = 0; first < values.size();) {
    const auto end = std::upper_bound(values.begin() + static_cast<std::ptrdiff_t>(first), values.end(), values[first]);
    const auto count = static_cast<std::size_t>(end - values.begin()) - first;
    if (count > most) {
      most = count;
      best = first;
    }
    first += count;
  }
  return std::bit_cast<float>(values[best]);
}

// Returns the median of the blocks' means, each weighted by its finite voxels.
float median_of(const RegionRows& rows, float fallback) {
  std::vector<std::pair<float, std::uint32_t>> means;
  std::uint64_t count = 0;
  rows.for_each([&](const Index3&, const LeafRow& row) {
    if (row.finite == 0) return;
    means.emplace_back(row.mean, row.finite);
    count += row.finite;
  });
  std::sort(means.begin(), means.end());
  std::uint64_t below = 0;
  for (const auto& [mean, voxels] : means) {
    below += voxels;
    if (2 * below >= count) return mean;
  }
  return fallback;
}

bool has_rungs(const RegionRows& rows) {
  bool found = false;
  rows.for_each([&](const Index3& leaf, const LeafRow&) {
    const PackedLadder& ladder = rows.ladder(leaf);
    found = found || ladder.count > 0 || ladder.near_count > 0;
  });
  return found;
}

// Says which blocks of a region are read well enough without a stream, if such blocks read a given value.
class SpareRule {
 public:
  SpareRule(const RegionRows& rows, const RegionSums& sums, const Fill& fill, const SharedUse& use)
      : fill_(fill), use_(use), exact_(!use.max_error && !has_rungs(rows)) {
    if (use.max_error || exact_) return;
    CompensatedSum about_mean;
    rows.for_each([&](const Index3&, const LeafRow& row) { about_mean.add(row.sse_about(sums.mean)); });
    small_ = about_mean.value() / static_cast<double>(64 * sums.voxels);
  }

  // Whether this rule demands exact values or a largest error, not only a small squared error.
  bool is_strict() const { return use_.max_error.has_value() || exact_; }

  bool spares(const LeafRow& row, float value) const {
    if (row.finite == 0 || exact_) return reads_exactly(row, value, fill_);
    if (use_.max_error) return row.max_abs_about(value) <= *use_.max_error;
    return row.sse_about(value) <= small_ * row.finite;
  }

  // False only if spares() is false for every value. The margin is for the rounding of spares().
  bool may_spare(const LeafRow& row) const {
    constexpr double kMargin = 1e-9;
    if (row.finite == 0) return fill_.non_finite != NonFinitePolicy::keep;
    if (exact_) return row.uniform();
    if (use_.max_error) {
      const double width = static_cast<double>(row.max) - static_cast<double>(row.min);
      return width <= 2 * *use_.max_error * (1 + kMargin);
    }
    const double residual = static_cast<double>(row.residual);
    const double off_mean = residual * residual / row.finite;  // sse_about() is least at the mean before rounding
    return row.sse - off_mean - kMargin * (row.sse + off_mean) <= small_ * row.finite;
  }

 private:
  const Fill& fill_;
  const SharedUse& use_;
  bool exact_;        // no block has anything between its mean and its exact values
  double small_ = 0;  // the squared error of a voxel that is not worth a stream
};

float shared_value(const RegionRows& rows, const Fill& fill, const SharedUse& use) {
  const RegionSums sums = sum_region(rows, fill);
  const std::uint64_t all = sums.voxels;
  const std::optional<float> uniform = commonest(sums.uniform);
  if (use.weighed) return uniform.value_or(sums.mean);
  const auto voxels_if = [&](const auto& holds) {
    std::uint64_t voxels = 0;
    rows.for_each([&](const Index3&, const LeafRow& row) { voxels += holds(row) ? voxels_of(row) : 0; });
    return voxels;
  };
  if (uniform && 2 * voxels_if([&](const LeafRow& row) { return reads_exactly(row, *uniform, fill); }) >= all) {
    return *uniform;
  }
  const SpareRule rule(rows, sums, fill, use);
  const auto spared_by = [&](float value) {
    return voxels_if([&](const LeafRow& row) { return rule.spares(row, value); });
  };
  const std::uint64_t with_uniform = uniform ? spared_by(*uniform) : 0;
  if (uniform && 2 * with_uniform >= all) return *uniform;
  if (8 * voxels_if([&](const LeafRow& row) { return rule.may_spare(row); }) >= 7 * all) {
    if (const float median = median_of(rows, fill.background); 8 * spared_by(median) >= 7 * all) return median;
  }
  // Blocks of few voxels, for example at a border, often have one value. A block that reads that value instead of the
  // mean is far off.
  const bool spares = rule.is_strict() || 128 * with_uniform >= all;
  return uniform && spares ? *uniform : sums.mean;
}

// The means that a block's stream may have. `whole`: it has no voxels outside the domain, which would take part in the
// mean. `filled`: the background takes the place of voxels that are not finite.
MinMax mean_range(const LeafRow& row, bool whole, bool filled, float background) {
  if (!whole) {
    return filled ? MinMax{std::min(row.min, background), std::max(row.max, background)} : MinMax{row.min, row.max};
  }
  if (!filled) return {row.mean, row.mean};
  const double share = static_cast<double>(row.finite) / static_cast<double>(kLeafVoxels);
  const auto mean =
      static_cast<float>(share * static_cast<double>(row.mean) + (1 - share) * static_cast<double>(background));
  return {mean, mean};
}

}  // namespace

SharedValues shared_values(const RegionRows& rows, const NodeLattice& leaves, const Fill& fill, const SharedUse& use) {
  SharedValues region;
  region.value = shared_value(rows, fill, use);
  MinMax means = kNoBounds;
  const bool all_whole = are_whole(leaves, rows.leaf_box());
  rows.for_each([&](const Index3& leaf, const LeafRow& row) {
    const std::int64_t voxels = all_whole ? kLeafVoxels : leaves.voxels(leaf).voxels();
    const bool filled = row.finite < voxels && fill.non_finite != NonFinitePolicy::keep;
    if (row.finite == 0 || (row.uniform() && !filled)) return;
    widen(means, mean_range(row, voxels == kLeafVoxels, filled, fill.background));
  });
  if (means.min <= means.max) region.means = {means.min, means.max};
  return region;
}

RegionStreams::RegionStreams(const MeanRange& means, const PackedRule& rule)
    : means_(means), coarsest_(rule.coarsest), finest_(rule.coarsest - 1) {
  for (std::size_t field = 0; field < mean_bits_.size(); ++field) {
    const std::int32_t step = coarsest_ + static_cast<std::int32_t>(field);
    mean_bits_[field] = static_cast<std::uint8_t>(step > kMostStep ? kNoMeanBits : mean_bits(means, step));
    if (mean_bits_[field] != kNoMeanBits) finest_ = step;
    if (step >= kLeastStep && step <= kMostStep)
      mean_errors_[field] = kMeanErrors[static_cast<std::size_t>(step - kLeastStep)];
  }
}

double RegionStreams::coarse_mean_error(std::int32_t written, const LeafRow& row, std::int64_t voxels) const {
  // Codes so far apart may hit the mean of many blocks, or miss it by as much.
  const float decoded = decode_mean(means_, written, mean_code(means_, written, row.mean));
  const double off = static_cast<double>(decoded) - static_cast<double>(row.mean);
  return off * off * static_cast<double>(voxels);
}

PackedKind packed_kind(const PackedLadder& ladder, KeptLevel level) {
  if (level == kExactLevel) {
    const bool raw = ladder.exact_bytes == kOneValueStreamBytes || ladder.exact_bytes == kRawStreamBytes;
    return raw ? PackedKind::raw : PackedKind::lattice;
  }
  if (level >= kFirstNearLevel) return PackedKind::lattice;
  return ladder.rungs[level - 1U].bits == kMeanAloneBits ? PackedKind::mean : PackedKind::transform;
}

PlannedStreams plan_streams(const RegionRows& rows, const TreeRegions& tree, const SharedValues& shared,
                            const PackedRule& rule, const LeafChoices& choices) {
  PlannedStreams plan;
  plan.region = shared;
  const RegionStreams streams(plan.region.means, rule);
  rows.for_each([&](const Index3& leaf, const LeafRow&) {
    const std::size_t position = tree.mask_position(leaf);
    const KeptLevel level = choices.level(position);
    if (level == 0) return;
    const PackedLadder& ladder = rows.ladder(leaf);
    plan.bytes[position] = static_cast<std::uint16_t>(streams.bytes(ladder, level));
    if (level == kExactLevel) {
      plan.steps[position] =
          ladder.exact == ExactKind::bounded ? PlannedStreams::kBoundedStep : PlannedStreams::kExactStep;
    } else if (level >= kFirstNearLevel) {
      const int exponent = ladder.near_exponent - (level - kFirstNearLevel);
      plan.steps[position] = static_cast<std::int16_t>(PlannedStreams::kNearStep + exponent);
    } else {
      plan.steps[position] = static_cast<std::int16_t>(streams.step(ladder, level - 1U));
    }
  });
  return plan;
}

void set_packed_counts(const PackedRule& rule, const TreeRegions& tree, std::uint64_t regions, NodeCounts& counts) {
  counts.packed_bytes = packed::chunks_offset(tree.regions.size());
  if (!rule.preview) return;
  // The lowest and the highest block stay leaves, so that the box others find is the domain.
  counts.uppers = tree.uppers.size();
  counts.lowers = regions;
  counts.leaves = tree.leaves.size() > 1 ? 2 : 1;
  counts.leaf_bytes = counts.leaves * nvdb::kFloatLeafBytes;
}

StreamPlaces::StreamPlaces(std::unique_ptr<PlannedStreams> plan) : plan_(std::move(plan)) {
  using packed::chunk::kGroupBlocks;
  std::uint32_t at = packed::chunk::kGroups;
  for (std::size_t group = 0; group < packed::chunk::kGroupCount; ++group) {
    bases_[group] = at;
    for (std::size_t b = 0; b < kGroupBlocks; ++b) {
      if (kept(group * kGroupBlocks + b)) masks_[group] = static_cast<std::uint16_t>(masks_[group] | 1U << b);
    }
    at +=
        static_cast<std::uint32_t>(packed::chunk::kEndBytes) * static_cast<std::uint32_t>(std::popcount(masks_[group]));
    for (std::size_t position = group * kGroupBlocks; position < (group + 1) * kGroupBlocks; ++position) {
      offsets_[position] = at;
      ordinals_[position] = static_cast<std::uint16_t>(streams_);
      at += plan_->bytes[position];
      streams_ += kept(position) ? 1 : 0;
    }
  }
  bases_.back() = at;
}

std::uint32_t StreamPlaces::chunk_bytes() const {
  constexpr auto kAlign = static_cast<std::uint32_t>(packed::chunk::kAlignment);
  return streams_ == 0 ? 0 : (bases_.back() + kAlign - 1) / kAlign * kAlign;
}

}  // namespace weir
