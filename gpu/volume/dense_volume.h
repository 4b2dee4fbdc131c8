// A dense volume: every voxel is a float32 in memory, filtered and bounded like the voxels of a file. It is the
// baseline for the pictures and speeds of files.
#pragma once

#include <cstdint>
#include <memory>

#include "gpu/scene/scene_camera.h"
#include "gpu/volume/macrocell_grid.h"
#include "gpu/volume/volume_sampler.h"

namespace weir {

/// The part of a DenseVolume that a kernel needs, in host or device memory. Voxel coordinates are local: 0 is the
/// lowest voxel of the domain.
struct DenseView {
  const float* values = nullptr;  ///< extent.x * extent.y * extent.z, x fastest
  Int3 extent;

  /// Returns the value of the local voxel `i`, 0 <= i < extent.
  WEIR_HOST_DEVICE float voxel(const Int3& i) const {
    return values[i.x + extent.x * (i.y + static_cast<std::int64_t>(extent.y) * i.z)];
  }

  /// Reads the 2 x 2 x 2 voxels from `i` up, x fastest, clamped to the extent. Always returns false, because the
  /// voxels are not known to be equal.
  WEIR_HOST_DEVICE bool taps(const Int3& i, float (&c)[8]) const {
    const std::int64_t x1 = i.x + 1 < extent.x ? 1 : 0;
    const std::int64_t y1 = i.y + 1 < extent.y ? extent.x : 0;
    const std::int64_t z1 = i.z + 1 < extent.z ? std::int64_t{extent.x} * extent.y : 0;
    const float* at = values + i.x + extent.x * (i.y + static_cast<std::int64_t>(extent.y) * i.z);
    for (int k = 0; k < 8; ++k) c[k] = at[((k & 1) != 0 ? x1 : 0) + ((k & 2) != 0 ? y1 : 0) + ((k & 4) != 0 ? z1 : 0)];
    return false;
  }
};

using DenseSampler = FilteredVolume<DenseView>;

class DenseVolume {
 public:
  /// `values` are all voxels of frame.domain, x fastest. `background` is the value around the domain; it is
  /// transparent if a scene gives no opacity.
  DenseVolume(const GridFrame& frame, std::unique_ptr<const float[]> values, float background);

  DenseView view() const;
  const GridFrame& frame() const { return frame_; }
  float background() const { return background_; }
  MinMax range() const { return range_; }  ///< of the finite values; the background if there are none
  std::uint64_t bytes() const { return static_cast<std::uint64_t>(frame_.domain.voxels()) * sizeof(float); }

 private:
  GridFrame frame_;
  std::unique_ptr<const float[]> values_;
  float background_;
  MinMax range_;
};

/// Makes cells of kMacrocell voxels, doubled until they have at least `edge` voxels. Their bounds are those of a
/// lossless file of the volume: of all values except NaN.
MacrocellGrid macrocells_of(const DenseVolume& volume, std::int64_t edge);

}  // namespace weir
