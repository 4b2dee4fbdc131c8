// The data that the blocks of a 128^3 region share in a packed file: the value of blocks without a stream, the range of
// the other blocks' means, and the bytes of each stream.
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
  float value = 0;  ///< the value that blocks without a stream read
  MeanRange means;  ///< of the blocks that are not uniform; {0, 0} if all are uniform
};

/// The purpose that the shared value of a region must serve.
struct SharedUse {
  std::optional<double> max_error = std::nullopt;  ///< the largest error that a voxel may have
  bool weighed = false;                            ///< a scene weighs errors
};

/// Returns the shared values of the region with these `rows`. `leaves` is the leaf lattice. A block needs no stream for
/// a value that is within `max_error` of all of the block's values. Without `max_error`, the block's mean squared error
/// about the value must be at most a 64th of the region's mean squared error about its mean. If no block has a rung,
/// the value must equal the block's values bit for bit. The region's value is the first of these:
/// - if a scene weighs errors, the commonest value of uniform blocks, or the mean if there are none;
/// - the commonest value of uniform blocks, if half of the voxels need no stream with it;
/// - the median of the blocks' means, if 7 of 8 voxels need no stream with it;
/// - the commonest value of uniform blocks, if a 128th of the voxels need no stream with it, if errors are bounded, or
///   if no block has a rung;
/// - the mean.
SharedValues shared_values(const RegionRows& rows, const NodeLattice& leaves, const Fill& fill, const SharedUse& use);

/// Bytes and errors of a region's streams, from its blocks' ladders and the range of its means.
class RegionStreams {
 public:
  RegionStreams(const MeanRange& means, const PackedRule& rule);

  /// Returns the bytes of a block's stream at `level`; 0 for level 0 or a level that is not available.
  std::uint32_t bytes(const PackedLadder& ladder, KeptLevel level) const {
    if (level == 0) return 0;
    if (level == kExactLevel) return ladder.exact_bytes;
    if (level >= kFirstNearLevel) return ladder.near[level - kFirstNearLevel].bytes;
    return bytes_of_rung(ladder, level - 1U);
  }
  /// Returns the step number of a rung's stream. If a region's means lie so far apart that their codes would have too
  /// many bits, a mean alone has a coarser step than its rung: the finest step at which means have codes.
  std::int32_t step(const PackedLadder& ladder, std::size_t rung) const {
    const std::int32_t step = ladder.step(rung);
    return ladder.rungs[rung].bits == kMeanAloneBits ? std::min(step, finest_) : step;
  }
  /// A block's stream.
  struct Stream {
    std::uint32_t bytes = 0;  ///< 0: the stream is not available, and has no error
    double error = 0;         ///< the expected squared error of the block's in-domain voxels
  };
  /// Return the stream of a rung and of a near rung.
  Stream rung(const PackedLadder& ladder, std::size_t rung, const LeafRow& row, std::int64_t voxels) const {
    const std::uint32_t bytes = bytes_of_rung(ladder, rung);
    return bytes == 0 ? Stream{} : Stream{bytes, error_of_rung(ladder, rung, row, voxels)};
  }
  static Stream near_rung(const PackedLadder& ladder, std::size_t rung, const LeafRow& row) {
    return {ladder.near[rung].bytes, ladder.near[rung].error.value() * row.sse};
  }
  /// Returns the expected squared error of a block's in-domain voxels at `level`, which is not 0.
  double error(const PackedLadder& ladder, KeptLevel level, const LeafRow& row, std::int64_t voxels) const {
    if (level == kExactLevel) return 0;
    if (level >= kFirstNearLevel) return near_rung(ladder, level - kFirstNearLevel, row).error;
    return error_of_rung(ladder, level - 1U, row, voxels);
  }

 private:
  // Returns 0 if the rung was not built or is not available.
  std::uint32_t bytes_of_rung(const PackedLadder& ladder, std::size_t rung) const {
    const std::uint32_t bits = ladder.rungs[rung].bits;
    const auto field = static_cast<std::uint32_t>(step(ladder, rung) - coarsest_);
    if (bits == 0 || field >= mean_bits_.size() || mean_bits_[field] == kNoMeanBits) return 0;
    return stream_bytes(bits, mean_bits_[field]);
  }
  double error_of_rung(const PackedLadder& ladder, std::size_t rung, const LeafRow& row, std::int64_t voxels) const {
    const std::int32_t written = step(ladder, rung);
    const double of_values = ladder.rungs[rung].error.value() * row.sse;
    if (written != ladder.step(rung) && row.finite == kLeafVoxels) {
      return of_values + coarse_mean_error(written, row, voxels);
    }
    const auto field = static_cast<std::size_t>(written - coarsest_);
    return of_values + mean_errors_[field] * static_cast<double>(voxels) / static_cast<double>(kLeafVoxels);
  }
  // Returns the squared error of the mean alone, written at a coarser step than its rung's.
  double coarse_mean_error(std::int32_t written, const LeafRow& row, std::int64_t voxels) const;

  MeanRange means_;
  std::int32_t coarsest_;
  std::int32_t finest_;  // finest step at which means have codes
  // By the field of the step.
  std::array<std::uint8_t, kPackedSteps> mean_bits_{};
  std::array<double, kPackedSteps> mean_errors_{};  // squared error of a block's mean
};

/// The planned streams of a region: bytes and step of each block. 0 bytes: the block has no stream.
struct PlannedStreams {
  SharedValues region;
  std::uint32_t reserved = 0;
  std::array<std::uint16_t, LeafChoices::kLeaves> bytes{};
  std::array<std::int16_t, LeafChoices::kLeaves> steps{};  ///< a quantiser's step, or one of the constants below

  static constexpr std::int16_t kExactStep = 0x7FFF;    ///< the exact kind
  static constexpr std::int16_t kBoundedStep = 0x7FFE;  ///< the kind with values rounded to within --max-error
  static constexpr std::int16_t kNearStep = 0x4000;     ///< plus exponent: rounded to multiples of 2^exponent

  static bool is_near(std::int16_t step) { return step >= kNearStep - 128 && step <= kNearStep + 128; }
  /// Returns whether `step` is the step of a quantiser.
  static bool transforms(std::int16_t step) { return step >= kLeastStep && step <= kMostStep; }
};
static_assert(sizeof(PlannedStreams) == 16 + 4 * LeafChoices::kLeaves, "plans are spilled as they are");

PackedKind packed_kind(const PackedLadder& ladder, KeptLevel level);

/// Plans the streams of a region from its leaves' choices. `shared` holds the region's shared values.
PlannedStreams plan_streams(const RegionRows& rows, const TreeRegions& tree, const SharedValues& shared,
                            const PackedRule& rule, const LeafChoices& choices);

/// Sets the node counts of a packed file of `regions` regions with streams, and in `packed_bytes` the bytes that are in
/// every file: header, tables and region table.
void set_packed_counts(const PackedRule& rule, const TreeRegions& tree, std::uint64_t regions, NodeCounts& counts);

using PlannedStreamsStore = RegionStore<PlannedStreams>;

/// The places of a region's streams in its chunk.
class StreamPlaces {
 public:
  explicit StreamPlaces(std::unique_ptr<PlannedStreams> plan);

  const PlannedStreams& plan() const { return *plan_; }
  bool kept(std::size_t position) const { return plan_->bytes[position] > 0; }
  std::uint32_t bytes(std::size_t position) const { return plan_->bytes[position]; }
  /// Returns the offset of the stream in bytes from the chunk's start.
  std::uint32_t offset(std::size_t position) const { return offsets_[position]; }
  /// Returns the number of streams before this position.
  std::uint32_t ordinal(std::size_t position) const { return ordinals_[position]; }
  /// Returns the base of a group of 16 positions, in bytes from the chunk's start. Group 256: the end of the last
  /// stream.
  std::uint32_t base(std::size_t group) const { return bases_[group]; }
  /// Bit b: position 16 * group + b has a stream.
  std::uint16_t mask(std::size_t group) const { return masks_[group]; }
  std::uint32_t streams() const { return streams_; }
  /// Returns the bytes of the chunk; 0 without streams.
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
