#include "compressor/forecast/sample_reaches.h"

#include <algorithm>
#include <cmath>

#include "compressor/conversion_control.h"
#include "format/leaf/bounds.h"
#include "ingest/plan/for_pieces.h"
#include "ingest/plan/staging.h"

namespace weir {

SampleReaches::SampleReaches(VolumeSource& volume, const SamplePlan& plan, const std::atomic<bool>* cancel)
    : leaves_(make_lattice(plan.domain(), kLeafDim)), reaches_(static_cast<std::size_t>(leaves_.size()), kNoBounds) {
  const Box domain = plan.domain();
  const Index3 cell = plan.cell();
  const Index3 places = plan.counts();
  for_pieces(leaves_.count.y * leaves_.count.z, kIoThreads, [&](std::int64_t i) {
    if (cancel != nullptr && *cancel) throw interrupted_error();
    const Index3 leaf{0, i % leaves_.count.y, i / leaves_.count.y};
    const Box one = leaves_.voxels(leaf);
    const Box row{{domain.lo.x, one.lo.y, one.lo.z}, {domain.hi.x, one.hi.y, one.hi.z}};
    Index3 place{0, (row.lo.y - domain.lo.y) / cell.y, (row.lo.z - domain.lo.z) / cell.z};
    for (; place.x < places.x; ++place.x) {
      const Box whole = plan.box(place);
      const Box piece = intersect(whole, row);
      read_piece(volume, piece, plan.source_corner(place) + (piece.lo - whole.lo));
    }
  });
}

// Reads `piece`, a row of leaves of the sample that begins at `corner` in the volume.
void SampleReaches::read_piece(VolumeSource& volume, const Box& piece, const Index3& corner) {
  const Box around = intersect(grown({corner, corner + piece.extent()}, 1), volume.info().domain());
  std::vector<float> values(static_cast<std::size_t>(around.voxels()));
  volume.read(around, values);
  const Index3 extent = around.extent();
  for (std::int64_t x = piece.lo.x; x < piece.hi.x; x = (floor_div(x, kLeafDim) + 1) * kLeafDim) {
    const std::int64_t end = std::min((floor_div(x, kLeafDim) + 1) * kLeafDim, piece.hi.x);
    const std::int64_t first = std::max<std::int64_t>(0, corner.x + (x - piece.lo.x) - 1 - around.lo.x);
    const std::int64_t last = std::min(extent.x, corner.x + (end - piece.lo.x) + 1 - around.lo.x);
    MinMax& reach = reaches_[index_of({x, piece.lo.y, piece.lo.z})];
    for (std::int64_t yz = 0; yz < extent.y * extent.z; ++yz) {
      for (std::int64_t at = yz * extent.x + first; at < yz * extent.x + last; ++at) {
        const float v = values[static_cast<std::size_t>(at)];
        if (std::isfinite(v)) widen(reach, {v, v});
      }
    }
  }
}

}  // namespace weir
