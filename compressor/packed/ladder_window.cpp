#include "compressor/packed/ladder_window.h"

namespace weir {

std::size_t start_rung(const KeyWindow& window, const PackedLadder& ladder) {
  return static_cast<std::size_t>(rung_about(ladder.first_step, window.step()));
}

std::size_t start_near_rung(const KeyWindow& window, const PackedLadder& ladder) {
  return static_cast<std::size_t>(near_rung_about(ladder.near_exponent, window.exponent()));
}

LadderRange range_within(const KeyWindow& window, const PackedLadder& ladder, const LeafRow& row) {
  LadderRange range;
  range.rungs = rungs_within(window, row.sse, start_rung(window, ladder), PackedLadder::kMeanRungs, ladder.count,
                             [&](std::size_t rung) { return ladder.point(rung); });
  if (ladder.near_count == 0) return range;
  range.near = rungs_within(window, row.sse, start_near_rung(window, ladder), 0, ladder.near_count,
                            [&](std::size_t rung) { return ladder.near_point(rung); });
  return range;
}

}  // namespace weir
