// The camera that a scene describes, in the frame of a grid. Physical space is
// index space with its voxels' proportions: lengths in shortest voxel edges.
#pragma once

#include <span>

#include "format/nanovdb/nvdb_grid.h"
#include "format/sidecar/scene.h"
#include "gpu/scene/camera.h"

namespace weir {

/// Where a grid lies: the centre of voxel `index` is at origin + voxel_size * index.
struct GridFrame {
  Box domain;          ///< voxels
  Double3 voxel_size;  ///< world units, > 0
  Double3 origin;      ///< world position of the centre of voxel (0, 0, 0)

  /// Edges of a voxel in units of the shortest.
  Double3 stretch() const;
  /// A point of index space, in which voxel i covers [i, i + 1), in physical space, whose origin is the domain's lowest
  /// corner.
  Double3 physical(const Double3& index) const;
  /// The place in the world of voxel `index`'s centre.
  Double3 world(const Index3& index) const;
  /// That place in the world as a point of index space, as physical() takes it.
  Double3 index(const Double3& world) const;
  /// Edges of the domain in physical space.
  Double3 size() const;
};

GridFrame frame_of(const NvdbGrid& grid);

/// Unit vectors: `up`, azimuth 0 and azimuth 90 degrees, a right-handed frame.
struct AzimuthFrame {
  Float3 up;
  Float3 ahead;
  Float3 left;
};

/// The frame about `up` (any length but 0) that azimuths of cameras are counted in, turned by `degrees`
/// counter-clockwise seen from above. Azimuth 0 is +x where up is +z.
AzimuthFrame azimuth_frame(const Double3& up, double degrees);

/// `aspect` is width / height. An orbiting camera stands where the boxes `content` (voxels, not
/// empty) fill the picture but for a small margin. Throws Error(usage) where position and look_at coincide, or one of
/// them is farther than 1e15 voxels away.
Camera make_camera(const SceneCamera& scene, const GridFrame& frame, std::span<const Box> content, double aspect);

}  // namespace weir
