// A source with its elements in reverse order along some axes. A file with latitudes that fall from north to south
// thus becomes a volume with rising positions.
#pragma once

#include <array>
#include <memory>

#include "ingest/source/volume_source.h"

namespace weir {

/// Returns `source` mirrored along each axis of `reversed` (x, y, z): the voxel at i is the source's voxel at the
/// same distance from the other end of its domain. The positions in source->info() are taken as those of the mirrored
/// volume. Returns `source` itself if no axis is reversed.
std::unique_ptr<VolumeSource> reverse_axes(std::unique_ptr<VolumeSource> source, const std::array<bool, 3>& reversed);

/// Returns the box of the original source, of domain `domain`, that holds the voxels of `box` of the mirrored one.
Box mirrored_box(const Box& box, const Box& domain, const std::array<bool, 3>& reversed);

}  // namespace weir
