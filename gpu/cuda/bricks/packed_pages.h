// Fills the pages of a packed grid: finds the blocks that need a brick. For host and device.
#pragma once

#include <vector>

#include "format/nanovdb/packed_data.h"
#include "gpu/cuda/bricks/page_steps.h"
#include "gpu/cuda/bricks/region_entries.h"
#include "gpu/cuda/packed/packed_view.h"

namespace weir {

/// The `Blocks` of FillPages.
struct PackedBlocks {
  PackedView view;

  WEIR_HOST_DEVICE PlainBlock at(const BlockLattice& lattice, const Int3& block) const {
    const FoundStream found = find_stream(view, lattice.id_of(block));
    if (found.data == nullptr) return {!found.damaged, found.value};
    return {false, 0.5F * found.means.low + 0.5F * found.means.high};
  }
};

/// Returns BlockSource::regions() of a packed grid.
inline std::vector<RegionEntry> packed_regions(const PackedData& packed) {
  return region_entries(packed.regions(), [&](const Index3& at) {
    const PackedRegion region = packed.region(at);
    return PlainBlock{region.chunk == 0, region.value};
  });
}

}  // namespace weir
