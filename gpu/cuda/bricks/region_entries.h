// Which regions of a grid need a page.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "format/base/index.h"
#include "gpu/cuda/bricks/page_steps.h"

namespace weir {

/// Returns the entries for BlockSource::regions(). `look` says of the region at a lattice position what FillPages
/// asks of blocks.
template <class Look>
std::vector<RegionEntry> region_entries(const NodeLattice& regions, const Look& look) {
  std::vector<RegionEntry> entries(static_cast<std::size_t>(regions.size()));
  for (std::int64_t r = 0; r < regions.size(); ++r) {
    const Index3 at = regions.position(r);
    const PlainBlock own = look(at);
    bool uniform = own.one_value;
    for (std::int64_t k = 1; k < 8 && uniform; ++k) {
      const PlainBlock above =
          look(Index3{std::min(at.x + (k & 1), regions.count.x - 1), std::min(at.y + (k >> 1 & 1), regions.count.y - 1),
                      std::min(at.z + (k >> 2), regions.count.z - 1)});
      uniform = above.one_value && same_value(above.value, own.value);
    }
    entries[static_cast<std::size_t>(r)] = {uniform ? 0 : RegionEntry::kMissing, own.value};
  }
  return entries;
}

}  // namespace weir
