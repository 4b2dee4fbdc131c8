// A 3-D array of texels on the device, read through the texture unit and written as a surface. Owns array, texture
// and surface.
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>

#include "gpu/math/vector3.h"

namespace weir {

/// Most texels along an axis of a 3-D texture, on every device since compute capability 5.0.
inline constexpr std::int32_t kMaxTextureEdge = 16384;

/// float32: floats; share16: 16 bits that are read as a fraction of the largest value, in [0, 1].
enum class TexelType { float32, share16 };

constexpr std::uint64_t texel_bytes(TexelType type) { return type == TexelType::float32 ? 4 : 2; }

class Texture {
 public:
  Texture() = default;
  /// Makes size.x * size.y * size.z uninitialised texels. They are read trilinearly, with unnormalised coordinates
  /// that are clamped to the edge. Throws DeviceFull if the device has no room, Error(input) if it has no textures of
  /// this size.
  explicit Texture(const Int3& size, TexelType type = TexelType::float32);
  ~Texture();
  Texture(Texture&& other) noexcept;
  Texture& operator=(Texture&& other) noexcept;

  cudaTextureObject_t object() const { return texture_; }
  cudaSurfaceObject_t surface() const { return surface_; }
  std::uint64_t bytes() const;
  /// Copies planes [z, z + depth) of floats from dense host memory, x fastest.
  void upload(const float* planes, std::int32_t z, std::int32_t depth);

 private:
  Int3 size_;
  TexelType type_ = TexelType::float32;
  cudaArray_t array_ = nullptr;
  cudaTextureObject_t texture_ = 0;
  cudaSurfaceObject_t surface_ = 0;
};

}  // namespace weir
