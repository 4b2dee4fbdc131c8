// The position of a grid of either VDB format, also as text for a listing.
#pragma once

#include <array>

#include "format/base/index.h"
#include "ingest/source/dataset_info.h"
#include "ingest/values/axis_placement.h"

namespace weir {

/// Returns whether place_axes() can make a spacing of these world steps: all are finite and none is zero.
bool placeable(const std::array<Vector3, 3>& steps, const Vector3& first);

/// Returns place_axes() for a grid with `active` as the bounding box of its active voxels; if the box is empty, for
/// index (0, 0, 0).
AxisPlacement place_grid(const std::array<Vector3, 3>& steps, const Vector3& zero, const Box& active);

/// Sets the extents and says where the box begins. A grid without active voxels gets an obstacle: it cannot be
/// converted.
void describe_box(const Box& active, DatasetInfo& info);
/// Adds voxel size, origin, and the parts of the transform that are not kept.
void describe_placement(const AxisPlacement& placement, DatasetInfo& info);

}  // namespace weir
