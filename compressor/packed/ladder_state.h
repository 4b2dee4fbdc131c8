// Which ladders the blocks of a volume get, as far as that is decided: by the whole conversion, and saved in its
// journal.
#pragma once

#include <optional>

#include "compressor/packed/ladder_window.h"
#include "format/packed/near_rungs.h"

namespace weir {

struct LadderState {
  bool decided = false;                  ///< before, the rest means nothing
  NearBlocks near{};                     ///< of the best file
  std::optional<double> centre{};        ///< of the window that cuts are expected in; none: all rungs count
  double reach = KeyWindow::kMostReach;  ///< of that window
  float width = 0;                       ///< of the values' range, as far as the sample of a window tells
  bool short_of_preview = false;         ///< the file is far too short for a preview that it need not have
  bool built = false;    ///< ladders are built so; else with all rungs, and near rungs of sampled blocks alone
  bool rebuilt = false;  ///< by a pass after the survey, which may not have come to its end
  int moves = 0;         ///< how often a cut lay outside the window, so that another one was taken

  std::optional<KeyWindow> window() const {
    return centre ? std::optional(KeyWindow(*centre, width, reach)) : std::nullopt;
  }
};

}  // namespace weir
