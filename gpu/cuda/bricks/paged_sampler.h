// The volume that kernels render where its blocks are bricks of a texture, and some of them are missing.
#pragma once

#include "gpu/cuda/bricks/brick_position.h"
#include "gpu/cuda/bricks/filtered_bricks.h"
#include "gpu/cuda/bricks/fixed_positions.h"
#include "gpu/cuda/bricks/page_table.h"
#include "gpu/cuda/runtime/pixel_tile.h"

namespace weir {

/// Tells the thread what it missed. `Positions`: FixedPositions, or WidePositions where those do not reach.
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
  /// Whether the thread's look-ups have missed something since it was last set to false; on the host always false.
  WEIR_HOST_DEVICE static bool missed() { return thread_missed(); }
  WEIR_HOST_DEVICE static void set_missed(bool missed) { set_thread_missed(missed); }
  WEIR_HOST_DEVICE static Float3 texel(const BrickEntry& entry, const Position& at) {
    return Positions::texel(entry, at);
  }
};

/// With the values of BrickSampler.
template <Filter kFilter, Noting kNoting, class Positions = FixedPositions>
using PagedSampler = FilteredBricks<PagedTable<Positions, kNoting>, kFilter>;

}  // namespace weir
