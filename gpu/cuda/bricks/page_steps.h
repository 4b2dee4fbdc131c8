// Steps that put pages in their place and tell which are in use. For host and device.
#pragma once

#include <cstdint>

#include "gpu/cuda/bricks/brick_slots.h"
#include "gpu/cuda/bricks/page_table.h"

namespace weir {

/// Names the pages of regions: for each of them.
struct PlacePages {
  RegionEntry* entries = nullptr;
  std::uint32_t* stamps = nullptr;
  const std::uint32_t* regions = nullptr;
  const std::uint32_t* pages = nullptr;
  std::uint32_t turn = 0;

  WEIR_HOST_DEVICE void operator()(std::uint32_t i) const {
    entries[regions[i]].page = pages[i];
    stamps[pages[i]] = turn;
  }
};

/// Forgets that regions were asked for: for each of them.
struct ForgetRegions {
  RegionEntry* entries = nullptr;
  const std::uint32_t* regions = nullptr;

  WEIR_HOST_DEVICE void operator()(std::uint32_t i) const { entries[regions[i]].page &= ~RegionEntry::kRequested; }
};

/// Stamps the pages of which something but a brick was used or asked for since the last time, after AgeSlots has
/// stamped those of bricks: for each entry, from page 1 on.
struct StampPages {
  BrickEntry* entries = nullptr;
  std::uint32_t* stamps = nullptr;
  std::uint32_t turn = 0;

  WEIR_HOST_DEVICE void operator()(std::uint32_t i) const {
    BrickEntry& entry = entries[std::size_t{kRegionBlocks} + i];
    if ((entry.state & (brick_state::kUsed | brick_state::kRequested)) == 0) return;
    stamps[1 + i / kRegionBlocks] = turn;
    entry.state &= ~brick_state::kUsed;
  }
};

}  // namespace weir
