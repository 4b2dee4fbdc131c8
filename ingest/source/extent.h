// Extents of volumes: which are valid, and how messages and options write them.
#pragma once

#include <cstdint>
#include <string>

#include "format/base/index.h"

namespace weir {

inline constexpr std::int64_t kMaxAxis = (std::int64_t{1} << 31U) - 1;  ///< NanoVDB coordinates are 32-bit

/// Returns the extent as "256x256x128".
std::string extent_text(const Index3& extent);
/// Returns the box as "x0:x1,y0:y1,z0:z1", half open, as --roi takes it.
std::string box_text(const Box& box);

/// Returns why a volume of `extent` voxels of `bytes_per_voxel` bytes each is impossible: an axis is below 1 or above
/// kMaxAxis, or the bytes of the file, or of the volume as float32, do not fit 63 bits. Returns an empty string if it
/// is possible.
std::string extent_obstacle(const Index3& extent, std::size_t bytes_per_voxel);

/// Returns the bytes of a volume of `extent` voxels. Throws Error(input), "WHERE: OBSTACLE", if extent_obstacle()
/// finds one.
std::uint64_t checked_volume_bytes(const Index3& extent, std::size_t bytes_per_voxel, const std::string& where);

}  // namespace weir
