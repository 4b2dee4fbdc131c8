// The decisions about which ladders the blocks of a volume get. They hold for the whole conversion and are saved in its
// journal.
#pragma once

#include <optional>

#include "compressor/packed/ladder_window.h"
#include "format/packed/near_rungs.h"

namespace weir {

struct LadderState {
  bool decided = false;                  ///< if false, the other members mean nothing
  NearBlocks near{};                     ///< blocks for which the best file uses near rungs
  std::optional<double> centre{};        ///< of the window in which cuts are expected; nullopt: all rungs count
  double reach = KeyWindow::kMostReach;  ///< of that window
  float width = 0;                       ///< of the values' range, as far as the window's sample tells
  bool short_of_preview = false;         ///< the file is far too short for an optional preview
  bool built = false;    ///< ladders are built by this; else with all rungs, near rungs only for sampled blocks
  bool rebuilt = false;  ///< by a pass after the survey, which may be unfinished
  int moves = 0;         ///< how often a cut lay outside the window and the window was replaced

  std::optional<KeyWindow> window() const {
    return centre ? std::optional(KeyWindow(*centre, width, reach)) : std::nullopt;
  }
};

}  // namespace weir
