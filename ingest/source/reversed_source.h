// Another source with its elements in reverse order along some of its axes: a file whose latitudes fall from north to
// south, as a volume whose positions rise.
#pragma once

#include <array>
#include <memory>

#include "ingest/source/volume_source.h"

namespace weir {

/// `source`, in which the voxel at i along each axis of `reversed` (x, y, z) is what lies as far from the other end of
/// its domain. All that its info says of positions is taken as said of the reversed volume. The source itself where no
/// axis is reversed.
std::unique_ptr<VolumeSource> reverse_axes(std::unique_ptr<VolumeSource> source, const std::array<bool, 3>& reversed);

/// Where a source of `domain` has the voxels that lie in `box` of the same with `reversed` axes.
Box mirrored_box(const Box& box, const Box& domain, const std::array<bool, 3>& reversed);

}  // namespace weir
