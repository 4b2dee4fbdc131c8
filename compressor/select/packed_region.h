// What the blocks of a 128^3 region have in common in a packed file: the value of those without a stream, the range
// of the others' means, and what each stream takes.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "compressor/leaf/fill.h"
#include "compressor/packed/packed_ladder.h"
#include "compressor/packed/packed_rule.h"
#include "compressor/select/leaf_choice.h"
#include "compressor/select/region_rows.h"
#include "compressor/select/region_store.h"
#include "compressor/select/tree_regions.h"
#include "format/layout/tree_layout.h"
#include "format/nanovdb/packed_data.h"
#include "format/packed/block_constants.h"
#include "format/packed/block_encode.h"
#include "format/packed/block_steps.h"
#include "format/packed/stream_length.h"

namespace weir {

struct SharedValues {
  float value = 0;  ///< what blocks without a stream read
  MeanRange means;  ///< of the blocks that are not uniform; {0, 0} where there is none
};

/// What the shared value of a region is to serve.
struct SharedUse {
  std::optional<double> max_error = std::nullopt;  ///< within which every voxel must be
  bool weighed = false;                            ///< a scene decides what matters
};

/// Of the region with those rows, in their order; `leaves` is the leaf lattice. A block needs no stream by a value that
/// is within `max_error` of all of its own. Without `max_error`, its mean squared error by the value must be at most a
/// 64th of the region's about its mean; where no block has a rung, it must read bit for bit. The region's value is the
/// first of these:
/// - where a scene weighs, the commonest value of uniform blocks, else the mean;
/// - the commonest value of uniform blocks, if half of the voxels need no stream by it;
/// - the median of the blocks' means, if 7 of 8 voxels need none by that;
/// - the commonest value of uniform blocks, if a 128th of the voxels need none by it, errors are bounded or no block
/// has
///   a rung;
/// - the mean.
SharedValues shared_values(const RegionRows& rows, const NodeLattice& leaves, const Fill& fill, const SharedUse& use);

/// What the streams of a region take and lose, from its blocks' ladders and the range of its means.
class RegionStreams {
 public:
  RegionStreams(const MeanRange& means, const PackedRule& rule);

  /// Bytes of a block's stream at a level; 0 where the level is none, or cannot be had.
  std::uint32_t bytes(const PackedLadder& ladder, KeptLevel level) const {
    if (level == 0) return 0;
    if (level == kExactLevel) return ladder.exact_bytes;
    if (level >= kFirstNearLevel) return ladder.near[level - kFirstNearLevel].bytes;
    return bytes_of_rung(ladder, level - 1U);
  }
  /// Step number of the stream of a rung. A mean alone has a coarser one than its rung where a region's means lie so
  /// far apart that their codes would have too many bits: the finest that they allow.
  std::int32_t step(const PackedLadder& ladder, std::size_t rung) const {
    const std::int32_t step = ladder.step(rung);
    return ladder.rungs[rung].bits == kMeanAloneBits ? std::min(step, finest_) : step;
  }
  /// Squared error expected of the in-domain voxels of a block at a level but 0.
  double error(const PackedLadder& ladder, KeptLevel level, const LeafRow& row, std::int64_t voxels) const;

 private:
  // 0 where it was not built, or cannot be had.
  std::uint32_t bytes_of_rung(const PackedLadder& ladder, std::size_t rung) const {
    const std::uint32_t bits = ladder.rungs[rung].bits;
    const auto field = static_cast<std::uint32_t>(step(ladder, rung) - coarsest_);
    if (bits == 0 || field >= mean_bits_.size() || mean_bits_[field] == kNoMeanBits) return 0;
    return stream_bytes(bits, mean_bits_[field]);
  }

  MeanRange means_;
  std::int32_t coarsest_;
  std::int32_t finest_;                                 // step at which means have codes
  std::array<std::uint8_t, kPackedSteps> mean_bits_{};  // by the field of the step
};

/// The streams of a region as planned: bytes and step of each block, 0 bytes where it has none.
struct PlannedStreams {
  SharedValues region;
  std::uint32_t reserved = 0;
  std::array<std::uint16_t, LeafChoices::kLeaves> bytes{};
  std::array<std::int16_t, LeafChoices::kLeaves> steps{};  ///< or one of these

  static constexpr std::int16_t kExactStep = 0x7FFF;    ///< the exact kind
  static constexpr std::int16_t kBoundedStep = 0x7FFE;  ///< that of values rounded to within --max-error
  static constexpr std::int16_t kNearStep = 0x4000;     ///< plus exponent: rounded to multiples of 2^exponent

  static bool is_near(std::int16_t step) { return step >= kNearStep - 128 && step <= kNearStep + 128; }
  /// Whether it is the step of a quantiser.
  static bool transforms(std::int16_t step) { return step >= kLeastStep && step <= kMostStep; }
};
static_assert(sizeof(PlannedStreams) == 16 + 4 * LeafChoices::kLeaves, "plans are spilled as they are");

PackedKind packed_kind(const PackedLadder& ladder, KeptLevel level);

/// `shared` are the region's.
PlannedStreams plan_streams(const RegionRows& rows, const TreeRegions& tree, const SharedValues& shared,
                            const PackedRule& rule, const LeafChoices& choices);

/// Sets what a packed file of `regions` regions with streams holds of tree nodes, and of `packed_bytes` what is in
/// every file: header, tables and region table.
void set_packed_counts(const PackedRule& rule, const TreeRegions& tree, std::uint64_t regions, NodeCounts& counts);

using PlannedStreamsStore = RegionStore<PlannedStreams>;

/// Where the streams of a region lie in its chunk.
class StreamPlaces {
 public:
  explicit StreamPlaces(std::unique_ptr<PlannedStreams> plan);

  const PlannedStreams& plan() const { return *plan_; }
  bool kept(std::size_t position) const { return plan_->bytes[position] > 0; }
  std::uint32_t bytes(std::size_t position) const { return plan_->bytes[position]; }
  /// From the chunk's start.
  std::uint32_t offset(std::size_t position) const { return offsets_[position]; }
  /// Streams before this position.
  std::uint32_t ordinal(std::size_t position) const { return ordinals_[position]; }
  /// Base of a group of 16 positions from the chunk's start; of group 256: the end of the last stream.
  std::uint32_t base(std::size_t group) const { return bases_[group]; }
  /// Bit b: position 16 * group + b has a stream.
  std::uint16_t mask(std::size_t group) const { return masks_[group]; }
  std::uint32_t streams() const { return streams_; }
  /// Of the chunk; 0 without streams.
  std::uint32_t chunk_bytes() const;

 private:
  std::unique_ptr<PlannedStreams> plan_;
  std::array<std::uint32_t, packed::chunk::kGroupCount + 1> bases_{};
  std::array<std::uint16_t, packed::chunk::kGroupCount> masks_{};
  std::array<std::uint32_t, LeafChoices::kLeaves> offsets_{};
  std::array<std::uint16_t, LeafChoices::kLeaves> ordinals_{};
  std::uint32_t streams_ = 0;
};

}  // namespace weir
