// The volume that kernels render where its blocks are bricks of a texture, and some of them are missing.
#pragma once

#include "gpu/cuda/bricks/brick_position.h"
#include "gpu/cuda/bricks/filtered_bricks.h"
#include "gpu/cuda/bricks/page_table.h"
#include "gpu/cuda/runtime/pixel_tile.h"

namespace weir {

/// Tells the thread what it missed.
struct PagedTable {
  PageTable pages;

  WEIR_HOST_DEVICE BrickPosition position(const Float3& q) const { return {pages.lattice, q}; }
  WEIR_HOST_DEVICE BrickEntry entry(const BrickPosition& at) const {
    const BrickEntry found = pages.find_or_request(at.block);
#if defined(__CUDA_ARCH__)
    if ((found.state & brick_state::kMissing) != 0) thread_missed() = true;
#endif
    return found;
  }
  WEIR_HOST_DEVICE static Float3 texel(const BrickEntry& entry, const BrickPosition& at) { return at.texel(entry); }
};

/// With the values of BrickSampler.
template <Filter kFilter>
using PagedSampler = FilteredBricks<PagedTable, kFilter>;

}  // namespace weir
