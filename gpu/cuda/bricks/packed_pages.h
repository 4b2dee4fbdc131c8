// The pages of a packed grid: which blocks need a brick. For host and device.
#pragma once

#include <cstdint>
#include <vector>

#include "format/nanovdb/packed_data.h"
#include "gpu/cuda/bricks/page_table.h"
#include "gpu/cuda/packed/packed_view.h"

namespace weir {

/// Fills the pages of regions: for each entry of each of them.
struct FillPackedPages {
  PackedView view;
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
      const FoundStream found = find_stream(view, lattice.id_of(lattice.above(block, k)));
      if (k == 0) value = found.data == nullptr ? found.value : 0.5F * found.means.low + 0.5F * found.means.high;
      uniform = uniform && found.data == nullptr && !found.damaged && same_value(found.value, value);
    }
    table.entries[static_cast<std::size_t>(pages[n]) * kRegionBlocks + i % kRegionBlocks] = {
        value, 0, 0, uniform ? 0 : brick_state::kMissing};
  }
};

/// BlockSource::regions() of a packed grid.
inline std::vector<RegionEntry> packed_regions(const PackedData& packed) {
  const NodeLattice& regions = packed.regions();
  std::vector<RegionEntry> entries(static_cast<std::size_t>(regions.size()));
  for (std::int64_t r = 0; r < regions.size(); ++r) {
    const Index3 at = regions.position(r);
    const PackedRegion own = packed.region(at);
    bool uniform = true;
    for (std::int64_t k = 0; k < 8; ++k) {
      const Index3 above{std::min(at.x + (k & 1), regions.count.x - 1),
                         std::min(at.y + (k >> 1 & 1), regions.count.y - 1),
                         std::min(at.z + (k >> 2), regions.count.z - 1)};
      const PackedRegion other = packed.region(above);
      uniform = uniform && other.chunk == 0 && same_value(other.value, own.value);
    }
    entries[static_cast<std::size_t>(r)] = {uniform ? 0 : RegionEntry::kMissing, own.value};
  }
  return entries;
}

}  // namespace weir
