#include "compressor/select/leaf_reach.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdlib>
#include <utility>
#include <vector>

#include "compressor/select/region_rows.h"
#include "format/leaf/bounds.h"

namespace weir {
namespace {

// The leaves of a box and the leaves around it.
struct Neighbourhood {
  Box box;
  std::vector<LeafRow> rows;
  std::vector<LeafFaces> faces;

  std::size_t at(const Index3& leaf) const {
    return static_cast<std::size_t>(linear_index(leaf - box.lo, box.extent()));
  }
};

class Reaches {
 public:
  Reaches(const NodeLattice& leaves, const Fill& fill, const CellPlaces* places)
      : leaves_(leaves), fill_(fill), places_(places) {}

  // Returns where the leaf's voxels lie in the volume that the scene shows.
  Box place_of(const Index3& leaf) const {
    const Box voxels = leaves_.voxels(leaf);
    if (places_ == nullptr) return voxels;
    const Index3 lo = places_->origin_of(voxels.lo);
    return {lo, lo + voxels.extent()};
  }

  MinMax of(const Index3& leaf, const Neighbourhood& around) const {
    MinMax reach = kNoBounds;
    const LeafRow& row = around.rows[around.at(leaf)];
    if (row.finite > 0) widen(reach, {row.min, row.max});
    widen_by_background(leaf, row, reach);
    if (const MinMax* const known = places_ == nullptr ? nullptr : places_->reach(leaves_.voxels(leaf).lo)) {
      widen(reach, *known);
      return reach;
    }
    const Box cell = places_ == nullptr ? Box{} : places_->cell(leaves_.voxels(leaf).lo);
    for_each_index(intersect(grown({leaf, leaf + Index3{1, 1, 1}}, 1), around.box), [&](const Index3& other) {
      if (other == leaf) return;
      const std::size_t i = around.at(other);
      if (places_ != nullptr && !cell.contains(leaves_.voxels(other).lo)) {
        extrapolate(around.faces[around.at(leaf)], other - leaf, leaves_.voxels(leaf).extent(), reach);
        return;
      }
      widen(reach, around.faces[i].touched_from(leaf - other));
      widen_by_background(other, around.rows[i], reach);
    });
    return reach;
  }

 private:
  // Widens `reach` by the background if it replaces a value of the leaf. The position of that value is not known, so
  // the background may be anywhere in the leaf.
  void widen_by_background(const Index3& leaf, const LeafRow& row, MinMax& reach) const {
    const bool keeps = fill_.non_finite == NonFinitePolicy::keep;
    if (!keeps && row.finite < leaves_.voxels(leaf).voxels()) widen(reach, {fill_.background, fill_.background});
  }

  // Widens `reach` by one layer beyond the face toward another cell. The bounds continue to change as they do from the
  // opposite face to this face.
  static void extrapolate(const LeafFaces& faces, const Index3& toward, const Index3& extent, MinMax& reach) {
    if (std::abs(toward.x) + std::abs(toward.y) + std::abs(toward.z) != 1) return;
    const MinMax& near = faces.touched_from(toward);
    const MinMax& far = faces.touched_from(Index3{0, 0, 0} - toward);
    const std::int64_t length = toward.x != 0 ? extent.x : toward.y != 0 ? extent.y : extent.z;
    if (length < 2 || near.min > near.max || far.min > far.max) return;
    const auto beyond = [&](float a, float b) { return a + (a - b) / static_cast<float>(length - 1); };
    reach.min = std::min(reach.min, beyond(near.min, far.min));
    reach.max = std::max(reach.max, beyond(near.max, far.max));
  }

  const NodeLattice& leaves_;
  const Fill& fill_;
  const CellPlaces* places_;
};

}  // namespace

Shown find_reaches(const LeafStore<LeafFaces>& faces, const Visibility& visibility, const Fill& fill,
                   const CellPlaces* places, WorkDirectory& work, RowStore& rows) {
  const NodeLattice& leaves = rows.leaves();
  auto store = std::make_unique<LeafStore<MinMax>>(work.spill_records(), leaves);
  const Box all{{0, 0, 0}, leaves.count};
  const Index3 regions = floor_div(leaves.count - Index3{1, 1, 1}, kLowerLeaves) + Index3{1, 1, 1};
  const Reaches reaches(leaves, fill, places);
  tbb::enumerable_thread_specific<Neighbourhood> neighbourhoods;
  tbb::enumerable_thread_specific<Shown> shown;
  const auto find = [&](std::int64_t task) {
    const Index3 lo = index_at(task, regions) * kLowerLeaves;
    const Box box = intersect({lo, lo + Index3{kLowerLeaves, kLowerLeaves, kLowerLeaves}}, all);
    Neighbourhood& around = neighbourhoods.local();
    around.box = intersect(grown(box, 1), all);
    rows.read_box(around.box, around.rows);
    faces.read_box(around.box, around.faces);
    Shown& seen = shown.local();
    std::vector<MinMax> found;
    found.reserve(static_cast<std::size_t>(box.voxels()));
    for_each_index(box, [&](const Index3& leaf) {
      found.push_back(visibility.in_region(reaches.place_of(leaf)) ? reaches.of(leaf, around) : kNoBounds);
      if (!visibility.shows(found.back())) return;
      ++seen.blocks;
      seen.finite += around.rows[around.at(leaf)].finite;
    });
    store->write_box(box, found);
  };
  Team& team = rows.team();
  const Share own = team.share(volume(regions));
  team.run([&] { tbb::parallel_for(own.begin, own.end, find); });
  team.publish(store->file());
  rows.set_reaches(std::move(store));
  std::array<std::uint64_t, 2> total{};
  for (const Shown& some : shown) {
    total[0] += some.blocks;
    total[1] += some.finite;
  }
  team.sum<std::uint64_t>(total);
  return {total[0], total[1]};
}

}  // namespace weir
