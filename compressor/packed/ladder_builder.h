// Surveys the ladder of one block after the other. One builder per thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "compressor/leaf/leaf_row.h"
#include "compressor/packed/packed_ladder.h"
#include "format/leaf/leaf_codec.h"
#include "format/packed/block_encode.h"
#include "format/packed/lattice_block.h"
#include "format/packed/rounded_block.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// What ladders are built for.
struct LadderAim {
  bool lossless = false;             ///< exact kinds alone
  bool keeps_non_finite = false;     ///< NaN and infinities stay
  std::optional<float> background;   ///< what else they become, where that is known
  std::optional<double> max_error;   ///< for each block the shortest stream whose values are all within it
  std::optional<Lattice> lattice{};  ///< of the whole volume
  bool near_rungs = false;           ///< a budget of bytes, or of an error, may buy them
};

/// The lattice that all values of a source lie on, where its type says so.
std::optional<Lattice> lattice_of(const SourceInfo& source);

/// Whether a ladder has near rungs, and its exact kind predicts floats.
enum class NearRungs { no, yes };

class LadderBuilder {
 public:
  explicit LadderBuilder(const LadderAim& aim) : aim_(aim) {}

  /// Of a block all of whose in-domain values are finite and not all the same: `block` are its 512 values, `row` what
  /// the survey knows of them.
  PackedLadder build(const LeafValues& block, const LeafRow& row, NearRungs near);
  /// Adds near rungs, and floats in order, to a ladder that build() has built of that block without them.
  void add_near(const LeafValues& block, PackedLadder& ladder);
  /// Of one whose in-domain values have the same bits.
  static PackedLadder uniform();
  /// Of one with values that are not finite. Where these become a background that is not known yet, its ladder is to
  /// be built once more (compressor/survey/ladder_completion.h).
  PackedLadder build_non_finite(LeafValues& block, const LeafRow& row, NearRungs near);

 private:
  // Whether the background is a part of the block. Its error does not count then: that of the whole is a bound.
  enum class Filled { no, yes };
  PackedLadder build(const LeafValues& block, const LeafRow& row, NearRungs near, Filled filled);
  // The errors of the rungs are shares of `energy`.
  void add_rungs(const LeafRow& row, double energy, PackedLadder& ladder);
  void set_exact(const LeafValues& block, NearRungs near, PackedLadder& ladder);
  void add_near_rungs(const LeafValues& block, double energy, PackedLadder& ladder);
  void build_bounded(const LeafValues& block, double max_error, PackedLadder& ladder);
  std::optional<std::int32_t> bounded_step(const LeafValues& block, double max_error);

  LadderAim aim_;
  TransformBlock transform_;
  RoundedBlock rounded_;
  std::vector<std::byte> stream_ = std::vector<std::byte>(4096);
};

}  // namespace weir
