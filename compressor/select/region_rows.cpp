#include "compressor/select/region_rows.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "compressor/team/region_share.h"

namespace weir {

namespace {

bool all_held(const RowStore& store) {
  return store.held() != nullptr && (store.reaches() == nullptr || store.reaches()->held() != nullptr) &&
         (store.ladders() == nullptr || store.ladders()->held() != nullptr);
}

// The rows of a box of leaves: in memory where they lie, or read into buffers.
class BoxRows {
 public:
  BoxRows(const RowStore& store, const Box& box, RowBuffers& buffers) : first_(box.lo), extent_(box.extent()) {
    if (all_held(store)) {
      first_ = {0, 0, 0};
      extent_ = store.leaves().count;
      rows_ = store.held();
      if (store.reaches() != nullptr) reaches_ = store.reaches()->held();
      if (store.ladders() != nullptr) ladders_ = store.ladders()->held();
      return;
    }
    store.read_box(box, buffers.rows);
    rows_ = buffers.rows.data();
    if (store.reaches() != nullptr) {
      store.reaches()->read_box(box, buffers.reaches);
      reaches_ = buffers.reaches.data();
    }
    if (store.ladders() != nullptr) {
      store.ladders()->read_box(box, buffers.ladders);
      ladders_ = buffers.ladders.data();
    }
  }

  RegionRows of(const Box& leaf_box) const {
    const std::int64_t at = linear_index(leaf_box.lo - first_, extent_);
    return {rows_ + at, extent_, leaf_box, reaches_ == nullptr ? nullptr : reaches_ + at,
            ladders_ == nullptr ? nullptr : ladders_ + at};
  }

 private:
  Index3 first_;  // leaf of the first row
  Index3 extent_;
  const LeafRow* rows_ = nullptr;
  const MinMax* reaches_ = nullptr;
  const PackedLadder* ladders_ = nullptr;
};

}  // namespace

RegionRows read_region(const RowStore& store, const Box& leaf_box, RowBuffers& buffers) {
  return BoxRows(store, leaf_box, buffers).of(leaf_box);
}

void for_each_region(const TreeRegions& tree, const RowStore& store, const Box& regions,
                     const std::function<void(std::int64_t, const RegionRows&)>& visit) {
  // One task is a region or, if rows are read from a file, a segment of regions along x, because its rows lie in long
  // runs. Segments are shorter if threads would otherwise have no work.
  const Index3 extent = regions.extent();
  const std::int64_t busy = 4 * static_cast<std::int64_t>(tbb::this_task_arena::max_concurrency());
  const std::int64_t longest = all_held(store) ? 1 : store.room().segment_regions;
  const std::int64_t segment = std::clamp<std::int64_t>(regions.voxels() / busy, 1, longest);
  const Index3 tasks{ceil_div(extent.x, segment), extent.y, extent.z};
  tbb::enumerable_thread_specific<RowBuffers> buffers;
  tbb::parallel_for(std::int64_t{0}, volume(tasks), [&](std::int64_t task) {
    const Index3 at = index_at(task, tasks);
    const Index3 first = regions.lo + Index3{at.x * segment, at.y, at.z};
    const std::int64_t end_x = std::min(first.x + segment, regions.hi.x);
    const std::int64_t begin = tree.region_lattice.linear(first);
    const std::int64_t last = tree.region_lattice.linear({end_x - 1, first.y, first.z});
    const Box box{tree.leaf_box(begin).lo, tree.leaf_box(last).hi};
    const BoxRows rows(store, box, buffers.local());
    for (std::int64_t region = begin; region <= last; ++region) visit(region, rows.of(tree.leaf_box(region)));
  });
}

void for_each_own_region(const TreeRegions& tree, const RowStore& store,
                         const std::function<void(std::int64_t, const RegionRows&)>& visit) {
  store.team().run([&] {
    for (const Box& box : own_regions(tree.region_lattice, store.team())) for_each_region(tree, store, box, visit);
  });
}

}  // namespace weir
