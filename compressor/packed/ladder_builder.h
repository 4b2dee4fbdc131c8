// Surveys the ladder of one block after the other. One builder per thread.
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

/// Whether a ladder has near rungs, and its exact kind predicts floats.
enum class NearRungs { no, yes };

inline bool is_sparse(const LeafRow& row) { return 2U * row.zeros > row.finite; }

/// What ladders are built for.
struct LadderAim {
  bool lossless = false;             ///< exact kinds alone
  bool keeps_non_finite = false;     ///< NaN and infinities stay
  std::optional<float> background;   ///< what else they become, where that is known
  std::optional<double> max_error;   ///< for each block the shortest stream whose values are all within it
  std::optional<Lattice> lattice{};  ///< of the whole volume
  bool near_rungs = false;           ///< a budget of bytes, or of an error, may buy them
  NearBlocks near{};                 ///< those that it is known to buy them for; before, a sample alone has them
  /// Where the cut is known to lie: the rungs that it cannot choose are left out.
  std::optional<KeyWindow> window{};
  BlockCoder* coder = nullptr;  ///< looks at the rungs of many blocks at a time, where there is one

  /// Who looks at rungs in the survey.
  BlockCoder* surveying_coder() const { return has_rungs() && !lattice ? coder : nullptr; }
  /// Which rungs it looks at.
  RungAsk rung_ask() const {
    RungAsk ask;
    if (window) {
      ask = {false, window->step(), {NearBlocks::none, false, window->exponent()}, window->keys()};
    }
    if (near_rungs) ask.near.blocks = near;
    return ask;
  }

  /// Which ladder a block gets in the survey.
  NearRungs near_for(const LeafRow& row, bool sampled) const {
    const bool bought = near == NearBlocks::all || (near == NearBlocks::sparse && is_sparse(row));
    return near_rungs && (bought || sampled) ? NearRungs::yes : NearRungs::no;
  }
  /// Whether ladders lead from few bytes to many, and a budget chooses.
  bool has_rungs() const { return !lossless && !max_error; }
};

/// The lattice that all values of a source lie on, where its type says so.
std::optional<Lattice> lattice_of(const SourceInfo& source);

class LadderBuilder {
 public:
  explicit LadderBuilder(const LadderAim& aim) : aim_(aim) {}

  /// Of a block all of whose in-domain values are finite and not all the same: `block` are its 512 values, `row` what
  /// the survey knows of them.
  PackedLadder build(const LeafValues& block, const LeafRow& row, NearRungs near);
  /// The same of what a coder has found of the block. Nullopt where that is not enough.
  std::optional<PackedLadder> build_from(const SurveyedBlock& found, const LeafRow& row, NearRungs near) const;
  /// Of one whose in-domain values have the same bits.
  static PackedLadder uniform();
  /// Of one with values that are not finite. Where these become a background that is not known yet, its ladder is to
  /// be built once more (compressor/survey/ladder_completion.h).
  PackedLadder build_non_finite(LeafValues& block, const LeafRow& row, NearRungs near);

 private:
  // Whether the background is a part of the block. Its error does not count then: that of the whole is a bound.
  enum class Filled { no, yes };
  PackedLadder build(const LeafValues& block, const LeafRow& row, NearRungs near, Filled filled);
  // Adds rungs of both kinds: all, or those that the window may choose. Returns whether a cut may choose what is finer
  // than those it adds.
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
