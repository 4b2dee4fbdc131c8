#include "compressor/select/near_use.h"

#include <cstddef>
#include <span>
#include <vector>

#include "compressor/packed/near_sample.h"
#include "compressor/select/step_keys.h"

namespace weir {
namespace {

/// The steps of sampled blocks, counted by their keys.
class SampledSteps {
 public:
  void add(const PackedLadder& ladder, const LeafStep& step) {
    Bucket& bucket = buckets_[key_bits(step.key) >> kDropped];
    const auto bytes = static_cast<double>(step.bytes);
    bucket.bytes += bytes;
    bucket.gain += step.gain;
    const bool exact = step.level == kExactLevel;
    if (exact ? ladder.exact == ExactKind::ordered : step.level >= kFirstNearLevel) bucket.near_bytes += bytes;
  }

  /// Whether near steps are among those that are bought for so many bytes.
  bool near_within_bytes(double bytes) const {
    double bought = 0;
    double near = 0;
    for (std::size_t i = buckets_.size(); i-- > 0 && bought <= bytes;) {
      bought += buckets_[i].bytes;
      near += buckets_[i].near_bytes;
    }
    return count(near, bought);
  }

  /// Whether they are among those that must be bought so that no more than that error is left.
  bool near_within_error(double squared_error) const {
    double left = 0;
    double bought = 0;
    double near = 0;
    for (const Bucket& bucket : buckets_) {
      left += bucket.gain;
      if (left <= squared_error) continue;
      bought += bucket.bytes;
      near += bucket.near_bytes;
    }
    return count(near, bought);
  }

 private:
  struct Bucket {
    double bytes = 0;
    double gain = 0;
    double near_bytes = 0;
  };
  static constexpr int kDropped = 48;  // bits of a key: 16 to an octave remain

  // Fewer are not worth to read the volume once more; a twentieth saves 6 dB of a sparse volume.
  static bool count(double near, double bought) { return near > bought / 256; }

  std::vector<Bucket> buckets_ = std::vector<Bucket>(std::size_t{1} << (64 - kDropped));
};

bool judge(const FileRequest& request, const RowStore& rows) {
  const NodeLattice& leaves = rows.leaves();
  GainRule rule = request.rule;
  rule.packed = PackedRule{false, request.packed.constants.coarsest};
  SampledSteps steps;
  RegionGains gains;
  std::int64_t samples = 0;
  for (std::int64_t i = 0; i < leaves.size(); ++i) {
    if (!is_near_sample(i, leaves.size())) continue;
    LeafRow row;
    rows.read(i, std::span(&row, 1));
    const std::int64_t voxels = leaves.voxels(leaves.position(i)).voxels();
    if (row.finite > 0 && row.finite < voxels) continue;
    ++samples;
    if (row.finite == 0 || row.uniform()) continue;
    PackedLadder ladder;
    rows.ladders()->read(i, std::span(&ladder, 1));
    MinMax reach;
    if (rule.visibility != nullptr) rows.reaches()->read(i, std::span(&reach, 1));
    // Alone in its region, its mean the value of blocks without a stream.
    const SharedValues region{row.mean, {request.packed.constants.minimum, request.packed.constants.maximum}};
    LeafGain leaf;
    gains.clear();
    gains.begin(leaf);
    rule.add_packed_steps(ladder, region, row, voxels, rule.visibility == nullptr ? nullptr : &reach, leaf, gains);
    for (const LeafStep& step : leaf.all_steps()) steps.add(ladder, step);
  }
  if (samples == 0) return true;  // nothing to judge by
  const double share = static_cast<double>(samples) / static_cast<double>(leaves.size());
  const Budget& budget = request.budget;
  if (budget.kind == Budget::Kind::psnr) return steps.near_within_error(request.squared_error * share);
  const auto dense = static_cast<std::uint64_t>(request.domain.voxels()) * sizeof(float);
  return steps.near_within_bytes(static_cast<double>(asked_bytes(budget, dense)) * share);
}

}  // namespace

bool uses_near_rungs(const FileRequest& request, const RowStore& rows) {
  bool uses = false;
  rows.team().lead([&] { uses = judge(request, rows); });
  rows.team().follow(uses);
  return uses;
}

}  // namespace weir
