// The worth of keeping a leaf: the steps that buy its error down. Their keys decide the order in which leaves are
// bought.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "compressor/leaf/encoding.h"
#include "compressor/leaf/fill.h"
#include "compressor/leaf/metric.h"
#include "compressor/packed/packed_ladder.h"
#include "compressor/packed/packed_rule.h"
#include "compressor/select/leaf_choice.h"
#include "compressor/select/packed_region.h"
#include "compressor/select/region_rows.h"
#include "compressor/survey/visibility.h"

namespace weir {

/// All widths of a kept leaf, narrowest first.
inline constexpr std::array kLeafWidths{LeafWidth::bits1, LeafWidth::bits2,  LeafWidth::bits4,
                                        LeafWidth::bits8, LeafWidth::bits16, LeafWidth::float32};

/// Returns the widths that an encoding may use for a leaf, narrowest first. For packed: the width of the corner leaves
/// of its preview.
constexpr std::span<const LeafWidth> widths_of(Encoding encoding) {
  const std::span<const LeafWidth> all = kLeafWidths;
  switch (encoding) {
    case Encoding::fpn:
      return all.first(5);
    case Encoding::fp4:
      return all.subspan(2, 1);
    case Encoding::fp8:
      return all.subspan(3, 1);
    case Encoding::fp16:
      return all.subspan(4, 1);
    case Encoding::automatic:
    case Encoding::float32:
    case Encoding::packed:
      break;
  }
  return all.last(1);
}

/// A step from one way to keep a leaf to the next better one. Members have no initial values, so that allocating room
/// for many steps costs nothing.
struct LeafStep {
  double gain;          ///< squared error saved, or the brick's distance
  double key;           ///< for sse gain / bytes, else gain: steps are bought by falling key
  std::uint32_t bytes;  ///< by which the file grows
  KeptLevel level;
};

struct LeafGain {
  /// The steps in the order in which they are bought, keys falling: the convex hull of error over bytes. None if the
  /// tile reads the same bits. The RegionGains own them.
  LeafStep* steps = nullptr;
  std::uint32_t step_count = 0;
  std::uint32_t brick = 0;     ///< rank of its brick in the region; for sse the leaf's own rank
  std::uint16_t position = 0;  ///< in the lower node's masks: x<<8 | y<<4 | z
  bool exact = false;          ///< its tile reads the same bits: never worth a leaf
  bool required = false;       ///< always a leaf: its first step is taken whatever it saves
  bool lossless = false;  ///< the last step, or the tile, reads the same bits (within max_error, or cannot be seen)

  std::span<const LeafStep> all_steps() const { return {steps, step_count}; }
  /// Returns the gain of the first step; 0 if there is no step.
  double first_gain() const { return step_count == 0 ? 0 : steps[0].gain; }
};

/// The gains of a region's leaves, in leaf-index order. Movable, not copyable: leaves point to their steps.
class RegionGains {
 public:
  /// The most steps of one leaf.
  static constexpr std::size_t kMostSteps = 36;
  static_assert(kMostSteps > PackedLadder::kMostRungs + PackedLadder::kMostNear, "each way of a ladder, the exact one");
  /// The most bytes of a region's gains and steps.
  static constexpr std::uint64_t kMostBytes = LeafChoices::kLeaves * (sizeof(LeafGain) + kMostSteps * sizeof(LeafStep));

  // Not initialised: pages that no step touches cost nothing.
  RegionGains()
      : leaves_(std::make_unique_for_overwrite<LeafGain[]>(LeafChoices::kLeaves)),
        steps_(std::make_unique_for_overwrite<LeafStep[]>(LeafChoices::kLeaves * kMostSteps)) {}

  void clear() { leaf_count_ = step_count_ = 0; }
  /// Begins `leaf`: the steps that add() gets next belong to it.
  void begin(LeafGain& leaf) { leaf.steps = steps_.get() + step_count_; }
  void add(LeafGain& leaf, const LeafStep& step) {
    steps_[step_count_++] = step;
    ++leaf.step_count;
  }
  void end(const LeafGain& leaf) { leaves_[leaf_count_++] = leaf; }

  const LeafGain* begin() const { return leaves_.get(); }
  const LeafGain* end() const { return leaves_.get() + leaf_count_; }
  LeafGain* begin() { return leaves_.get(); }
  LeafGain* end() { return leaves_.get() + leaf_count_; }
  std::size_t size() const { return leaf_count_; }
  const LeafGain& operator[](std::size_t i) const { return leaves_[i]; }

  /// For a packed region: the shared values by which its steps were found.
  SharedValues shared;

 private:
  std::unique_ptr<LeafGain[]> leaves_;
  std::size_t leaf_count_ = 0;
  std::unique_ptr<LeafStep[]> steps_;
  std::size_t step_count_ = 0;
};

/// The rule that decides gains. The result is the same for every number of threads, plan and memory ceiling.
struct GainRule {
  Metric metric = Metric::sse;
  std::int64_t brick_leaves = 1;  ///< leaves along a brick of the paper's metrics: 1, 2 or 4
  Fill fill;
  Encoding encoding = Encoding::float32;  ///< not automatic
  /// The largest error that a voxel may have. If a leaf's tile exceeds it, the leaf is required at the first width that
  /// meets it (quantised over the leaf's whole range). Nothing else is worth a byte. A leaf that no width can hold
  /// within the error counts as lossy.
  std::optional<double> max_error = std::nullopt;
  /// The visibility by a scene, or null. Errors are weighted by what the scene shows of them, and a leaf that it cannot
  /// show is never worth a byte. For Metric::sse, over rows with reaches.
  const Visibility* visibility = nullptr;
  /// Set if blocks are packed: the steps of each block come from its ladder, which the rows then have.
  std::optional<PackedRule> packed = std::nullopt;

  /// Return the bytes that opening a region and opening an upper node take in the file.
  std::uint64_t region_bytes() const {
    if (!packed) return nvdb::kLowerBytes;
    return kChunkCost + (packed->preview ? nvdb::kLowerBytes : 0);
  }
  std::uint64_t upper_bytes() const { return packed ? 0 : nvdb::kUpperBytes; }

  /// Returns the weight of the error of a block of that `reach` that reads `tile`.
  double tile_weight(const MinMax& reach, float tile) const;

  /// Finds the gains of a region's leaves in leaf-index order. Required are the two corner leaves of the domain (not of
  /// a packed file without a preview), leaves with non-finite values to keep, leaves that fill.splits() or
  /// keeps_active() says, and blocks without a finite value that would not read the background. Other leaves may get no
  /// steps if all their keys are below `least_key`, because finding steps is most of the work.
  void gains(const TreeRegions& tree, const RegionRows& rows, RegionGains& out, double least_key = 0) const;

  /// Adds a packed block's steps to `out`. `leaf` says whether the block reads the same bits without a stream, and
  /// whether it is required. `reach` is null if all errors count alike.
  void add_packed_steps(const PackedLadder& ladder, const SharedValues& region, const RegionStreams& streams,
                        const LeafRow& row, std::int64_t voxels, const MinMax* reach, LeafGain& leaf,
                        RegionGains& out) const;

 private:
  // The weights of a squared error if the leaf reads its tile, and if the leaf is kept.
  struct Weights {
    double tile = 1;
    double kept = 1;
  };
  void add_bounded_step(const LeafRow& row, std::int64_t voxels, float tile, const Weights& weights, LeafGain& leaf,
                        RegionGains& out) const;
  void add_steps(const LeafRow& row, std::int64_t voxels, float tile, const Weights& weights, LeafGain& leaf,
                 RegionGains& out) const;
  Weights weights_of(const MinMax* reach, float tile) const;
  // Returns whether it is certain, without finding the steps, that all keys of a leaf that may be a tile are below
  // `least_key`.
  bool keys_below(double least_key, const LeafRow& row, float tile, const Weights& weights) const;
  // For the paper's metrics: sets the gain of each leaf from its brick's range.
  void rank_bricks(const RegionRows& rows, RegionGains& leaves) const;
};

/// Returns the squared error over the finite values of a leaf of `voxels` in-domain voxels that is kept at `width`,
/// with `background` in place of its other values: 0 if keeps_every_bit(), otherwise an estimate.
double quantised_error(const LeafRow& row, std::int64_t voxels, float background, LeafWidth width);
/// Returns a bound of |decoded - value| over a leaf's in-domain voxels at `width`, quantised over its whole range: half
/// a quantum plus the decoder's rounding, fused or not. `background` takes the place of non-finite values.
double bounded_error(const LeafRow& row, std::int64_t voxels, float background, LeafWidth width);
/// Returns whether a leaf of `voxels` in-domain voxels reads every bit if it is kept at `width` with `background` in
/// place of non-finite values.
bool keeps_every_bit(const LeafRow& row, std::int64_t voxels, float background, LeafWidth width);

}  // namespace weir
