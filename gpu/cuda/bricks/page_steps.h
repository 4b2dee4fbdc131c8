// Steps that assign pages and find out which are in use. For host and device.
#pragma once

#include <cstdint>

#include "gpu/cuda/bricks/brick_slots.h"
#include "gpu/cuda/bricks/page_table.h"

namespace weir {

/// Writes the page numbers into the entries of regions. Runs for each region.
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

/// Clears the request flags of regions. Runs for each region.
struct ForgetRegions {
  RegionEntry* entries = nullptr;
  const std::uint32_t* regions = nullptr;

  WEIR_HOST_DEVICE void operator()(std::uint32_t i) const { entries[regions[i]].page &= ~RegionEntry::kRequested; }
};

/// Stamps pages in which an entry that has no brick was used or requested since the last time. AgeSlots must run
/// before: it stamps the pages of used bricks. Runs for each entry, from page 1 on.
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

/// What a page needs to know of a block.
struct PlainBlock {
  bool one_value = false;
  float value = 0;  ///< the one value, or an approximation
};

/// Fills the pages of regions. Runs for each entry of each page. `Blocks` describes the blocks of a lattice by
/// at(lattice, block).
template <class Blocks>
struct FillPages {
  Blocks blocks;
  PageTable table;
  const std::uint32_t* regions = nullptr;
  const std::uint32_t* pages = nullptr;

  WEIR_HOST_DEVICE void operator()(std::uint32_t i) const {
    const BlockLattice& lattice = table.lattice;
    const std::uint32_t n = i / kRegionBlocks;
    const Int3 block = lattice.block_at(static_cast<BlockId>(regions[n]) * kRegionBlocks + i % kRegionBlocks);
    float value = 0;
    bool uniform = true;
    for (std::uint32_t k = 0; k < 8 && lattice.contains(block); ++k) {
      const PlainBlock found = blocks.at(lattice, lattice.above(block, k));
      if (k == 0) value = found.value;
      uniform = uniform && found.one_value && same_value(found.value, value);
    }
    table.entries[static_cast<std::size_t>(pages[n]) * kRegionBlocks + i % kRegionBlocks] = {
        value, 0, 0, uniform ? 0 : brick_state::kMissing};
  }
};

}  // namespace weir
