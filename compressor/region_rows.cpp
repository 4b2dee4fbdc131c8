#include "compressor/region_rows.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace weir {

void for_each_region(const TreeRegions& tree, const RowStore& store, const Box& regions,
                     const std::function<void(std::int64_t, const RegionRows&)>& visit) {
  // One task: a segment of regions along x, whose rows are read in long runs.
  const std::int64_t segment = store.segment_regions();
  const Index3 extent = regions.extent();
  const Index3 tasks{(extent.x + segment - 1) / segment, extent.y, extent.z};
  tbb::enumerable_thread_specific<std::vector<LeafRow>> buffers;
  tbb::parallel_for(std::int64_t{0}, volume(tasks), [&](std::int64_t task) {
    const Index3 at = index_at(task, tasks);
    const Index3 first = regions.lo + Index3{at.x * segment, at.y, at.z};
    const std::int64_t end_x = std::min(first.x + segment, regions.hi.x);
    const std::int64_t begin = tree.region_lattice.linear(first);
    const std::int64_t last = tree.region_lattice.linear({end_x - 1, first.y, first.z});
    const Box box{tree.leaf_box(begin).lo, tree.leaf_box(last).hi};
    std::vector<LeafRow>& rows = buffers.local();
    store.read_box(box, rows);
    for (std::int64_t region = begin; region <= last; ++region) {
      const Box leaf_box = tree.leaf_box(region);
      visit(region, RegionRows(rows.data() + (leaf_box.lo.x - box.lo.x), box.extent(), leaf_box));
    }
  });
}

void for_each_region(const TreeRegions& tree, const RowStore& store,
                     const std::function<void(std::int64_t, const RegionRows&)>& visit) {
  for_each_region(tree, store, {{0, 0, 0}, tree.region_lattice.count}, visit);
}

}  // namespace weir
