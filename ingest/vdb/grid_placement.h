// Where a grid of either VDB format lies, in the words of a listing.
#pragma once

#include <array>

#include "format/base/index.h"
#include "ingest/source/dataset_info.h"
#include "ingest/values/axis_placement.h"

namespace weir {

/// Whether place_axes makes a spacing of these world steps: all finite, none zero.
bool placeable(const std::array<Vector3, 3>& steps, const Vector3& first);

/// place_axes of a grid whose active voxels have the bounding box `active`; empty: of index (0, 0, 0).
AxisPlacement place_grid(const std::array<Vector3, 3>& steps, const Vector3& zero, const Box& active);

/// Sets the extents, and says where the box begins; a grid without active voxels cannot be converted.
void describe_box(const Box& active, DatasetInfo& info);
/// Adds voxel size, origin and what of the transform is not kept.
void describe_placement(const AxisPlacement& placement, DatasetInfo& info);

}  // namespace weir
