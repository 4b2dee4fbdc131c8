// A 3-D array of floats on the device, read through the texture unit and written
// as a surface. Owns both.
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>

#include "gpu/math/vector3.h"

namespace weir {

/// Texels along an axis of a 3-D texture, on every device since compute capability 5.0.
inline constexpr std::int32_t kMaxTextureEdge = 16384;

class Texture {
 public:
  Texture() = default;
  /// size.x * size.y * size.z floats, uninitialised; read trilinear, unnormalised coordinates, clamped to the edge.
  /// Throws Error(io) where the device has no room, Error(input) where it has no textures that large.
  explicit Texture(const Int3& size);
  ~Texture();
  Texture(Texture&& other) noexcept;
  Texture& operator=(Texture&& other) noexcept;

  cudaTextureObject_t object() const { return texture_; }
  cudaSurfaceObject_t surface() const { return surface_; }
  std::uint64_t bytes() const;
  /// Planes [z, z + depth) from dense host memory, x fastest.
  void upload(const float* planes, std::int32_t z, std::int32_t depth);

 private:
  Int3 size_;
  cudaArray_t array_ = nullptr;
  cudaTextureObject_t texture_ = 0;
  cudaSurfaceObject_t surface_ = 0;
};

}  // namespace weir
