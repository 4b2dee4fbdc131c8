// What a budget will buy of a packed volume, as far as a sample of its blocks (compressor/packed/block_sample.h) tells:
// which ladders are worth building for all of them, and whether the file can be long enough for a preview.
#pragma once

#include <optional>

#include "compressor/packed/ladder_state.h"
#include "compressor/packed/ladder_window.h"
#include "compressor/select/encoding_choice.h"
#include "compressor/survey/row_store.h"

namespace weir {

struct BudgetOutlook {
  /// Which blocks the best file keeps some of by near rungs or as floats in order.
  NearBlocks near{};
  /// Where the cut of the selection lies, about. None: unknown, or all can be bought, or a scene weighs.
  std::optional<KeyWindow> window{};
  /// Of an error to be met: whether the file that does it is so short that it gets no preview unless one is asked for.
  /// Only where that is clear: else its plan decides.
  bool short_of_preview = false;
};

/// What that decides.
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

/// Volumes of fewer blocks have all rungs built: looking ahead would take as long.
inline constexpr std::int64_t kLeastForecastBlocks = 16384;

/// By the sampled blocks whose values are all finite; `rows` has their rows, and ladders with all rungs. Of the request
/// it looks at the budget, the domain, the preview and what the scene weighs. Whatever else is known of the volume does
/// not count, so that the outlook is the same before the survey and after it. The same on all ranks.
/// Throws as File::read_at.
BudgetOutlook outlook_of(const FileRequest& request, const RowStore& rows);

}  // namespace weir
