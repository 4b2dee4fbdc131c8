#include "ingest/hdf5/meaning/elements_read.h"

#include <algorithm>
#include <array>

#include "ingest/source/reversed_source.h"

namespace weir {

Box voxels_read(const VolumeSlice& slice, const std::optional<VolumeRegion>& region) {
  const Box domain{{}, slice.extent};
  if (!region) return domain;
  const Box wanted = mirrored_box(intersect(region->in(domain), domain), domain, slice.falls);
  return wanted.empty() ? domain : wanted;
}

ElementRange elements_read(std::span<const AxisPlace> axes, const VolumeSlice& slice,
                           const std::optional<VolumeRegion>& region) {
  ElementRange range{std::vector<hsize_t>(axes.size()), {}};
  for (const AxisPlace& axis : axes) range.hi.push_back(static_cast<hsize_t>(axis.extent));
  std::size_t next = 0;  // positions are those of the other axes, in order, but for one of components that are all read
  for (std::size_t axis = 0; axis < axes.size() && next < slice.positions.size(); ++axis) {
    if (std::ranges::find(slice.roles.volume, axis) != slice.roles.volume.end()) continue;
    range.lo[axis] = static_cast<hsize_t>(slice.positions[next++]);
    range.hi[axis] = range.lo[axis] + 1;
  }
  const VoxelComponents& components = slice.components;
  const bool last_of_components = components.count > 1 && !slice.planar && slice.roles.volume.back() + 1 < axes.size();
  if (last_of_components && !components.choice.magnitude) {
    range.lo.back() = static_cast<hsize_t>(components.choice.position);
    range.hi.back() = range.lo.back() + 1;
  }
  const Box read = voxels_read(slice, region);
  const std::array<std::int64_t, 3> lo{read.lo.z, read.lo.y, read.lo.x};
  const std::array<std::int64_t, 3> hi{read.hi.z, read.hi.y, read.hi.x};
  for (std::size_t i = 0; i < kVolumeRank; ++i) {
    range.lo[slice.roles.volume.at(i)] = static_cast<hsize_t>(lo.at(i));
    range.hi[slice.roles.volume.at(i)] = static_cast<hsize_t>(hi.at(i));
  }
  return range;
}

}  // namespace weir
