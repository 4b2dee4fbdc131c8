#include "compressor/packed/ladder_window.h"

namespace weir {

std::size_t start_rung(const KeyWindow& window, const PackedLadder& ladder) {
  return static_cast<std::size_t>(rung_about(ladder.first_step, window.step()));
}

std::size_t start_near_rung(const KeyWindow& window, const PackedLadder& ladder) {
  return static_cast<std::size_t>(near_rung_about(ladder.near_exponent, window.exponent()));
}

LadderRange range_within(const KeyWindow& window, const PackedLadder& ladder, const LeafRow& row) {
  const auto at = [&](std::size_t rung) { return ladder.point(rung); };
  const auto near_at = [&](std::size_t rung) { return ladder.near_point(rung); };
  return ranges_within(window, row.sse,
                       RungSearch{start_rung(window, ladder), PackedLadder::kMeanRungs, std::size_t{ladder.count}, at},
                       RungSearch{start_near_rung(window, ladder), 0, std::size_t{ladder.near_count}, near_at});
}

}  // namespace weir
