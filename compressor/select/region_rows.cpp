#include "compressor/select/region_rows.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "compressor/team/region_share.h"

namespace weir {

namespace {

void read_box(const RowStore& store, const Box& box, RowBuffers& buffers) {
  store.read_box(box, buffers.rows);
  if (store.reaches() != nullptr) store.reaches()->read_box(box, buffers.reaches);
  if (store.ladders() != nullptr) store.ladders()->read_box(box, buffers.ladders);
}

// Of the leaf `first` in boxes of rows.
RegionRows rows_from(const RowStore& store, const RowBuffers& buffers, std::size_t first, const Index3& row_extent,
                     const Box& leaf_box) {
  return {buffers.rows.data() + first, row_extent, leaf_box,
          store.reaches() == nullptr ? nullptr : buffers.reaches.data() + first,
          store.ladders() == nullptr ? nullptr : buffers.ladders.data() + first};
}

}  // namespace

RegionRows read_region(const RowStore& store, const Box& leaf_box, RowBuffers& buffers) {
  read_box(store, leaf_box, buffers);
  return rows_from(store, buffers, 0, leaf_box.extent(), leaf_box);
}

void for_each_region(const TreeRegions& tree, const RowStore& store, const Box& regions,
                     const std::function<void(std::int64_t, const RegionRows&)>& visit) {
  // One task: a segment of regions along x, whose rows are read in long runs; shorter where threads would have no work.
  const Index3 extent = regions.extent();
  const std::int64_t busy = 4 * static_cast<std::int64_t>(tbb::this_task_arena::max_concurrency());
  const std::int64_t segment = std::clamp<std::int64_t>(regions.voxels() / busy, 1, store.segment_regions());
  const Index3 tasks{(extent.x + segment - 1) / segment, extent.y, extent.z};
  tbb::enumerable_thread_specific<RowBuffers> buffers;
  tbb::parallel_for(std::int64_t{0}, volume(tasks), [&](std::int64_t task) {
    const Index3 at = index_at(task, tasks);
    const Index3 first = regions.lo + Index3{at.x * segment, at.y, at.z};
    const std::int64_t end_x = std::min(first.x + segment, regions.hi.x);
    const std::int64_t begin = tree.region_lattice.linear(first);
    const std::int64_t last = tree.region_lattice.linear({end_x - 1, first.y, first.z});
    const Box box{tree.leaf_box(begin).lo, tree.leaf_box(last).hi};
    RowBuffers& local = buffers.local();
    read_box(store, box, local);
    for (std::int64_t region = begin; region <= last; ++region) {
      const Box leaf_box = tree.leaf_box(region);
      const auto first_row = static_cast<std::size_t>(leaf_box.lo.x - box.lo.x);
      visit(region, rows_from(store, local, first_row, box.extent(), leaf_box));
    }
  });
}

void for_each_own_region(const TreeRegions& tree, const RowStore& store,
                         const std::function<void(std::int64_t, const RegionRows&)>& visit) {
  store.team().run([&] {
    for (const Box& box : own_regions(tree.region_lattice, store.team())) for_each_region(tree, store, box, visit);
  });
}

}  // namespace weir
