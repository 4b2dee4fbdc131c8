// Extents of volumes: which are valid, and how messages and options write them.
#pragma once

#include <cstdint>
#include <string>

#include "format/base/index.h"

namespace weir {

inline constexpr std::int64_t kMaxAxis = (std::int64_t{1} << 31U) - 1;  ///< NanoVDB coordinates are 32-bit

/// "256x256x128".
std::string extent_text(const Index3& extent);
/// "x0:x1,y0:y1,z0:z1", half open, as --roi takes it.
std::string box_text(const Box& box);

/// Why there is no volume of `extent` voxels of `bytes_per_voxel` each: an axis is below 1 or above kMaxAxis, or the
/// bytes, of the file or of the volume as float32, do not fit 63 bits. Empty where there is one.
std::string extent_obstacle(const Index3& extent, std::size_t bytes_per_voxel);

/// Bytes of such a volume. Throws Error(input), "WHERE: OBSTACLE", where there is none.
std::uint64_t checked_volume_bytes(const Index3& extent, std::size_t bytes_per_voxel, const std::string& where);

}  // namespace weir
