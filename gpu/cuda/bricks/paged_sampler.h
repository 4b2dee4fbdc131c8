// The volume that kernels render if its blocks are bricks of a texture and some bricks are missing.
#pragma once

#include "gpu/cuda/bricks/brick_position.h"
#include "gpu/cuda/bricks/filtered_bricks.h"
#include "gpu/cuda/bricks/fixed_positions.h"
#include "gpu/cuda/bricks/page_table.h"
#include "gpu/cuda/runtime/pixel_tile.h"

namespace weir {

/// Notes for the thread what it missed. `Positions` is FixedPositions, or WidePositions for domains that are too
/// large for it.
template <class Positions, Noting kNoting>
struct PagedTable {
  using Position = typename Positions::Position;
  static constexpr Noting kNotes = kNoting;

  PageTable pages;
  Positions positions;

  WEIR_HOST_DEVICE Position position(const Float3& q) const { return positions.at(q); }
  WEIR_HOST_DEVICE BrickEntry entry(const Position& at) const {
    const BrickEntry found = pages.template find_or_request<kNoting>(positions.region(at), positions.in_region(at));
    if ((found.state & brick_state::kMissing) != 0) set_thread_missed(true);
    return found;
  }
  /// Returns whether the thread's look-ups have missed something since the flag was last set to false. Always false
  /// on the host.
  WEIR_HOST_DEVICE static bool missed() { return thread_missed(); }
  WEIR_HOST_DEVICE static void set_missed(bool missed) { set_thread_missed(missed); }
  WEIR_HOST_DEVICE static Float3 texel(const BrickEntry& entry, const Position& at) {
    return Positions::texel(entry, at);
  }
};

/// Has the same values as BrickSampler.
template <Filter kFilter, Noting kNoting, class Positions = FixedPositions>
using PagedSampler = FilteredBricks<PagedTable<Positions, kNoting>, kFilter>;

}  // namespace weir
