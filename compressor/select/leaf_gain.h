// What keeping a leaf is worth: the steps by which its error is bought down, and
// so the order in which leaves are bought.
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

/// All of a leaf that is kept, narrowest first.
inline constexpr std::array kLeafWidths{LeafWidth::bits1, LeafWidth::bits2,  LeafWidth::bits4,
                                        LeafWidth::bits8, LeafWidth::bits16, LeafWidth::float32};

/// The widths that a decided encoding may use for a leaf, narrowest first; of packed that of the corners of its
/// preview.
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

/// From one way to keep a leaf to the next better one. Without initial values, so that room for many costs nothing.
struct LeafStep {
  double gain;          ///< squared error saved, or the brick's distance
  double key;           ///< for sse gain / bytes, else gain: steps are bought by falling key
  std::uint32_t bytes;  ///< what the file grows by
  KeptLevel level;
};

struct LeafGain {
  /// In the order they are bought, keys falling: the convex hull of error over bytes. None where the tile
  /// reads the same bits. They live in the RegionGains.
  LeafStep* steps = nullptr;
  std::uint32_t step_count = 0;
  std::uint32_t brick = 0;     ///< rank of its brick in the region; of itself for sse
  std::uint16_t position = 0;  ///< in the lower node's masks: x<<8 | y<<4 | z
  bool exact = false;          ///< its tile reads the same bits: never worth a leaf
  bool required = false;       ///< always a leaf: its first step is taken whatever it saves
  bool lossless = false;  ///< the last step, or the tile, reads the same bits (within max_error, or cannot be seen)

  std::span<const LeafStep> all_steps() const { return {steps, step_count}; }
  /// Of the first step; 0 where there is none.
  double first_gain() const { return step_count == 0 ? 0 : steps[0].gain; }
};

/// The gains of a region's leaves, in leaf-index order. Movable, not copyable: leaves point to their steps.
class RegionGains {
 public:
  /// Most steps of one leaf.
  static constexpr std::size_t kMostSteps = 36;
  static_assert(kMostSteps > PackedLadder::kMostRungs + PackedLadder::kMostNear, "each way of a ladder, the exact one");
  /// Most bytes of a region's.
  static constexpr std::uint64_t kMostBytes = LeafChoices::kLeaves * (sizeof(LeafGain) + kMostSteps * sizeof(LeafStep));

  // Pages that no step touches cost nothing.
  RegionGains()
      : leaves_(std::make_unique_for_overwrite<LeafGain[]>(LeafChoices::kLeaves)),
        steps_(std::make_unique_for_overwrite<LeafStep[]>(LeafChoices::kLeaves * kMostSteps)) {}

  void clear() { leaf_count_ = step_count_ = 0; }
  /// The steps that come are those of `leaf`.
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

  /// Of a packed region: the values by which its steps were found.
  SharedValues shared;

 private:
  std::unique_ptr<LeafGain[]> leaves_;
  std::size_t leaf_count_ = 0;
  std::unique_ptr<LeafStep[]> steps_;
  std::size_t step_count_ = 0;
};

/// Decides gains; the same for every thread, plan and memory ceiling.
struct GainRule {
  Metric metric = Metric::sse;
  std::int64_t brick_leaves = 1;  ///< leaves along a brick of the paper's metrics: 1, 2 or 4
  Fill fill;
  Encoding encoding = Encoding::float32;  ///< not automatic
  /// Every voxel must read within this of its value: a leaf whose tile does not is required, at the first
  /// width that does (quantised over its whole range), and nothing else is worth a byte. What no width can do
  /// counts as lossy.
  std::optional<double> max_error = std::nullopt;
  /// Where a scene decides what matters: errors are weighted by what it shows of them, and what it cannot show is
  /// never worth a byte. For Metric::sse, over rows with reaches.
  const Visibility* visibility = nullptr;
  /// Blocks are packed: the steps of each are those of its ladder, over rows that have one.
  std::optional<PackedRule> packed = std::nullopt;

  /// What opening a region takes in the file, and opening an upper node.
  std::uint64_t region_bytes() const {
    if (!packed) return nvdb::kLowerBytes;
    return kChunkCost + (packed->preview ? nvdb::kLowerBytes : 0);
  }
  std::uint64_t upper_bytes() const { return packed ? 0 : nvdb::kUpperBytes; }

  /// Weight of the error where a block of that reach reads `tile`.
  double tile_weight(const MinMax& reach, float tile) const;

  /// Gains of a region's leaves in leaf-index order. The two corner leaves of the domain, those that hold
  /// non-finite values to keep, and packed blocks without a finite value that would not read the background are
  /// required. Leaves that are not, and whose steps all have keys below `least_key`, may have none: to find their steps
  /// is most of the work.
  void gains(const TreeRegions& tree, const RegionRows& rows, RegionGains& out, double least_key = 0) const;

  /// Adds a packed block's steps to `out`: `leaf` says whether a block without a stream reads the same bits, and
  /// whether it is required. `reach` is null where everything counts alike.
  void add_packed_steps(const PackedLadder& ladder, const SharedValues& region, const RegionStreams& streams,
                        const LeafRow& row, std::int64_t voxels, const MinMax* reach, LeafGain& leaf,
                        RegionGains& out) const;

 private:
  // What a squared error counts where the leaf reads its tile, and where it is kept.
  struct Weights {
    double tile = 1;
    double kept = 1;
  };
  void add_bounded_step(const LeafRow& row, std::int64_t voxels, float tile, const Weights& weights, LeafGain& leaf,
                        RegionGains& out) const;
  void add_steps(const LeafRow& row, std::int64_t voxels, float tile, const Weights& weights, LeafGain& leaf,
                 RegionGains& out) const;
  Weights weights_of(const MinMax* reach, float tile) const;
  // Whether no step of a leaf that may be a tile has a key of `least_key`, as far as is known without its steps.
  bool keys_below(double least_key, const LeafRow& row, float tile, const Weights& weights) const;
  // The paper's metrics: gain of each leaf from its brick's range.
  void rank_bricks(const RegionRows& rows, RegionGains& leaves) const;
};

/// Squared error over the finite values of a leaf of `voxels` in-domain voxels kept at `width`, the others replaced
/// by `background`: 0 where keeps_every_bit(), else an estimate.
double quantised_error(const LeafRow& row, std::int64_t voxels, float background, LeafWidth width);
/// Bound of |decoded - value| over a leaf's in-domain voxels at `width`, quantised over its whole range: half a
/// quantum, and what the decoder rounds, fused or not. `background` takes the place of non-finite values.
double bounded_error(const LeafRow& row, std::int64_t voxels, float background, LeafWidth width);
/// Whether a leaf of `voxels` in-domain voxels, kept at `width`, reads every bit, and `background` in the place of
/// non-finite values.
bool keeps_every_bit(const LeafRow& row, std::int64_t voxels, float background, LeafWidth width);

}  // namespace weir
