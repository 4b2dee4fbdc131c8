// A dense volume on one device: a texture and its macrocells.
#pragma once

#include <algorithm>
#include <vector>

#include "gpu/cuda/volume/device_macrocells.h"
#include "gpu/cuda/volume/texture.h"
#include "gpu/volume/dense_volume.h"

namespace weir {

/// Copies all voxels of `volume` (host memory) to a texture on the current device.
inline Texture make_texture(const DenseView& volume) {
  constexpr std::int64_t kVoxelsAtOnce = std::int64_t{1} << 26;
  Texture texture(volume.extent);
  const std::int64_t plane = static_cast<std::int64_t>(volume.extent.x) * volume.extent.y;
  const auto planes = static_cast<std::int32_t>(std::clamp<std::int64_t>(kVoxelsAtOnce / plane, 1, volume.extent.z));
  for (std::int32_t z = 0; z < volume.extent.z; z += planes) {
    texture.upload(volume.values + plane * z, z, std::min(planes, volume.extent.z - z));
  }
  return texture;
}

struct DenseTexture {
  DenseTexture(const DenseView& volume, const std::vector<MinMax>& bounds)
      : texture(make_texture(volume)), cells(bounds) {}

  Texture texture;
  DeviceMacrocells cells;
};

}  // namespace weir
