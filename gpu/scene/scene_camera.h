// The camera that a scene describes, in the frame of a grid. Physical space is index space with the proportions of
// the voxels: its unit is the shortest voxel edge.
#pragma once

#include <span>

#include "format/nanovdb/nvdb_grid.h"
#include "format/sidecar/scene.h"
#include "gpu/scene/camera.h"

namespace weir {

/// The position of a grid: the centre of voxel `index` is at origin + voxel_size * index.
struct GridFrame {
  Box domain;          ///< voxels
  Double3 voxel_size;  ///< world units, > 0
  Double3 origin;      ///< world position of the centre of voxel (0, 0, 0)

  /// Returns the edges of a voxel in units of the shortest edge.
  Double3 stretch() const;
  /// Converts a point of index space, in which voxel i covers [i, i + 1), to physical space. The origin of physical
  /// space is the domain's lowest corner.
  Double3 physical(const Double3& index) const;
  /// Returns the world position of the centre of voxel `index`.
  Double3 world(const Index3& index) const;
  /// Converts a world position to a point of index space, as physical() takes it.
  Double3 index(const Double3& world) const;
  /// Returns the edges of the domain in physical space.
  Double3 size() const;
};

GridFrame frame_of(const NvdbGrid& grid);

/// Unit vectors of a right-handed frame: `up`, azimuth 0 (`ahead`) and azimuth 90 degrees (`left`).
struct AzimuthFrame {
  Float3 up;
  Float3 ahead;
  Float3 left;
};

/// Returns the frame about `up` (any length except 0) that gives a camera's azimuth, turned by `degrees`
/// counter-clockwise seen from above. Azimuth 0 is +x if up is +z.
AzimuthFrame azimuth_frame(const Double3& up, double degrees);

/// Makes the camera. `aspect` is width / height. An orbiting camera stands where the boxes `content` (voxels, not
/// empty) fill the picture except for a small margin. Throws Error(usage) if position and look_at coincide, or if one
/// of them is more than 1e15 voxels away.
Camera make_camera(const SceneCamera& scene, const GridFrame& frame, std::span<const Box> content, double aspect);

}  // namespace weir
