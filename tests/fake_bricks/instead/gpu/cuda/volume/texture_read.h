// In place of the texture unit: trilinear, clamped to the edge, with 8 bits of each weight.
#pragma once

#include <cuda_runtime_api.h>

#include <algorithm>
#include <cmath>

#include "gpu/math/vector3.h"
#include "tests/fake_cuda/fake_array.h"

namespace weir {

inline float read_texture(cudaTextureObject_t texture, const Float3& at) {
  const test::FakeArray& texels = test::array_of(texture);
  const Float3 from{at.x - 0.5F, at.y - 0.5F, at.z - 0.5F};
  const Float3 low{std::floor(from.x), std::floor(from.y), std::floor(from.z)};
  const auto weight = [](float share) { return std::round(share * 256) / 256; };
  const Float3 share{weight(from.x - low.x), weight(from.y - low.y), weight(from.z - low.z)};
  const auto inside = [](float v, int above, std::size_t size) {
    return std::clamp(static_cast<std::int32_t>(v) + above, 0, static_cast<std::int32_t>(size) - 1);
  };
  float sum = 0;
  for (int k = 0; k < 8; ++k) {
    const float part = ((k & 1) != 0 ? share.x : 1 - share.x) * ((k & 2) != 0 ? share.y : 1 - share.y) *
                       ((k & 4) != 0 ? share.z : 1 - share.z);
    if (part == 0) continue;
    const Int3 i{inside(low.x, k & 1, texels.width), inside(low.y, k >> 1 & 1, texels.height),
                 inside(low.z, k >> 2, texels.depth)};
    sum += part * (texels.texel_bytes == sizeof(float) ? texels.read<float>(i)
                                                       : static_cast<float>(texels.read<unsigned short>(i)) / 65535);
  }
  return sum;
}

}  // namespace weir
