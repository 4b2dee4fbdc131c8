// Builds the ladder of one block after the other in the survey. Use one builder per thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "compressor/leaf/leaf_row.h"
#include "compressor/packed/exact_block.h"
#include "compressor/packed/ladder_state.h"
#include "compressor/packed/ladder_window.h"
#include "compressor/packed/packed_ladder.h"
#include "compressor/packed/rung_builders.h"
#include "format/leaf/leaf_codec.h"
#include "format/packed/block_coder.h"
#include "format/packed/block_encode.h"
#include "format/packed/lattice_block.h"
#include "format/packed/rounded_block.h"
#include "format/packed/stream_length.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Whether a ladder has near rungs and its exact kind predicts floats.
enum class NearRungs { no, yes };

inline bool is_sparse(const LeafRow& row) { return 2U * row.zeros > row.finite; }

/// The aim for which ladders are built.
struct LadderAim {
  bool lossless = false;             ///< exact kinds alone
  bool keeps_non_finite = false;     ///< NaN and infinities stay
  std::optional<float> background;   ///< the value that replaces non-finite values, if it is known
  std::optional<double> max_error;   ///< for each block the shortest stream whose values are all within it
  std::optional<Lattice> lattice{};  ///< of the whole volume
  bool near_rungs = false;           ///< whether near rungs may be built: a budget of bytes or of an error may buy them
  NearBlocks near{};  ///< blocks known to be bought by near rungs, which get them; sampled blocks always get them
  /// The window in which the cut is known to lie. Rungs that the cut cannot choose are left out.
  std::optional<KeyWindow> window{};
  BlockCoder* coder = nullptr;  ///< if not null, looks at the rungs of many blocks at a time

  /// Returns the coder that looks at rungs in the survey; null if the builder does.
  BlockCoder* surveying_coder() const { return has_rungs() && !lattice ? coder : nullptr; }
  /// Returns the rungs at which surveying_coder() looks.
  RungAsk rung_ask() const {
    RungAsk ask;
    if (window) {
      ask = {false, window->step(), {NearBlocks::none, false, window->exponent()}, window->keys()};
    }
    if (near_rungs) ask.near.blocks = near;
    return ask;
  }

  /// Returns whether a block gets near rungs in the survey.
  NearRungs near_for(const LeafRow& row, bool sampled) const {
    const bool bought = near == NearBlocks::all || (near == NearBlocks::sparse && is_sparse(row));
    return near_rungs && (bought || sampled) ? NearRungs::yes : NearRungs::no;
  }
  /// Returns whether ladders have rungs from few bytes to many, among which a budget chooses.
  bool has_rungs() const { return !lossless && !max_error; }
};

/// Returns the lattice on which all values of a source lie by its type; nullopt if its type implies none.
std::optional<Lattice> lattice_of(const SourceInfo& source);

class LadderBuilder {
 public:
  explicit LadderBuilder(const LadderAim& aim) : aim_(aim) {}

  /// Builds the ladder of a block with finite in-domain values that are not all the same. `block` has its 512 values,
  /// `row` the survey's figures of them.
  PackedLadder build(const LeafValues& block, const LeafRow& row, NearRungs near);
  /// Builds the same ladder from a coder's findings about the block. Returns nullopt if they are not enough.
  std::optional<PackedLadder> build_from(const SurveyedBlock& found, const LeafRow& row, NearRungs near) const;
  /// Returns the ladder of a block whose in-domain values all have the same bits.
  static PackedLadder uniform();
  /// Builds the ladder of a block with values that are not finite. If they become a background that is not known yet,
  /// the ladder must be built again later (compressor/survey/ladder_completion.h).
  PackedLadder build_non_finite(LeafValues& block, const LeafRow& row, NearRungs near);

 private:
  // Whether the background fills a part of the block. The error of that part does not count, so the error of the whole
  // block is a bound.
  enum class Filled { no, yes };
  PackedLadder build(const LeafValues& block, const LeafRow& row, NearRungs near, Filled filled);
  // Adds rungs of both kinds: all, or only those that the window may choose. Returns whether a cut may choose a finer
  // way than the added rungs.
  template <class CostOf, class NearCostOf>
  bool add_rungs(const LeafRow& row, TransformRungs<CostOf> rungs, NearRungBuilder<NearCostOf> near,
                 PackedLadder& ladder) const;
  void set_exact(const LeafValues& block, FloatOrder order, PackedLadder& ladder);
  void build_bounded(const LeafValues& block, double max_error, PackedLadder& ladder);
  std::optional<std::int32_t> bounded_step(const LeafValues& block, double max_error);

  LadderAim aim_;
  TransformBlock transform_;
  RoundedBlock rounded_;
  ExactBlock exact_;
  std::vector<std::byte> stream_ = std::vector<std::byte>(kStreamRoom);
};

}  // namespace weir
