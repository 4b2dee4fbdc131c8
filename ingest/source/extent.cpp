#include "ingest/source/extent.h"

#include <algorithm>
#include <array>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {

std::string extent_text(const Index3& extent) { return cat(extent.x, 'x', extent.y, 'x', extent.z); }

std::string box_text(const Box& box) {
  return cat(box.lo.x, ':', box.hi.x, ',', box.lo.y, ':', box.hi.y, ',', box.lo.z, ':', box.hi.z);
}

std::string extent_obstacle(const Index3& extent, std::size_t bytes_per_voxel) {
  const std::array<std::pair<char, std::int64_t>, 3> axes{{{'x', extent.x}, {'y', extent.y}, {'z', extent.z}}};
  for (const auto& [axis, voxels] : axes) {
    if (voxels >= 1 && voxels <= kMaxAxis) continue;
    return cat("extent ", extent_text(extent), " has ", voxels, " voxels along ", axis, "; each axis must be 1 to ",
               kMaxAxis);
  }
  std::int64_t voxels = 0;
  std::int64_t bytes = 0;
  // Everything downstream is float32, so the bytes of the volume as float32 must be countable, too.
  const auto widest = static_cast<std::int64_t>(std::max(bytes_per_voxel, sizeof(float)));
  if (__builtin_mul_overflow(extent.x * extent.y, extent.z, &voxels) ||
      __builtin_mul_overflow(voxels, widest, &bytes)) {
    return cat("extent ", extent_text(extent), " at ", widest, " bytes a voxel overflows 64 bits; check the extent");
  }
  return {};
}

std::uint64_t checked_volume_bytes(const Index3& extent, std::size_t bytes_per_voxel, const std::string& where) {
  const std::string obstacle = extent_obstacle(extent, bytes_per_voxel);
  if (!obstacle.empty()) throw input_error(where, obstacle);
  return static_cast<std::uint64_t>(extent.x * extent.y * extent.z) * bytes_per_voxel;
}

}  // namespace weir
