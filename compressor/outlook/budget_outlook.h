// Predicts from a sample of blocks (compressor/packed/block_sample.h) what a budget will buy of a packed volume: which
// ladders are worth building for all blocks, and whether the file can be long enough for a preview.
#pragma once

#include <optional>

#include "compressor/packed/ladder_state.h"
#include "compressor/packed/ladder_window.h"
#include "compressor/select/encoding_choice.h"
#include "compressor/survey/row_store.h"

namespace weir {

struct BudgetOutlook {
  /// The kinds of blocks of which the best file keeps some by near rungs or as floats in order.
  NearBlocks near{};
  /// The window in which the selection's cut nearly always lies. nullopt: unknown, all can be bought, or a scene
  /// weighs.
  std::optional<KeyWindow> window{};
  /// For an error budget: the file that meets it is clearly so short that it gets no preview unless one is asked for.
  /// If false, the file's plan decides.
  bool short_of_preview = false;
};

/// Returns the ladder state that `outlook` decides.
inline LadderState decided_by(const BudgetOutlook& outlook) {
  LadderState state{true, outlook.near};
  if (outlook.window) {
    state.centre = outlook.window->centre();
    state.reach = outlook.window->reach();
    state.width = outlook.window->width();
  }
  state.short_of_preview = outlook.short_of_preview;
  return state;
}

/// Volumes of fewer blocks get all rungs, because looking ahead would take as long as building them.
inline constexpr std::int64_t kLeastForecastBlocks = 16384;

/// Returns the outlook by the sampled blocks with only finite values. `rows` has their rows, and ladders with all
/// rungs. Uses only the budget, the domain, the preview and the scene's weights of the request, so that the outlook is
/// the same before and after the survey. The outlook is the same on all ranks. Throws as File::read_at() does.
BudgetOutlook outlook_of(const FileRequest& request, const RowStore& rows);

}  // namespace weir
