#include "gpu/cuda/volume/texture.h"

#include <cuda_runtime.h>

#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "gpu/cuda/runtime/check.h"
#include "gpu/cuda/volume/device_memory.h"

namespace weir {

// Delegates to the empty texture's constructor, so that the destructor runs if the rest throws.
Texture::Texture(const Int3& size, TexelType type) : Texture() {
  size_ = size;
  type_ = type;
  const std::string extent = cat(size.x, " x ", size.y, " x ", size.z);
  if (max_component({static_cast<float>(size.x), static_cast<float>(size.y), static_cast<float>(size.z)}) >
      kMaxTextureEdge) {
    throw Error(ErrorKind::input,
                cat("a texture of ", extent, " voxels, at most ", kMaxTextureEdge, " an axis can be"));
  }
  const cudaChannelFormatDesc format =
      type == TexelType::float32 ? cudaCreateChannelDesc<float>() : cudaCreateChannelDesc<unsigned short>();
  const cudaExtent texels{static_cast<std::size_t>(size.x), static_cast<std::size_t>(size.y),
                          static_cast<std::size_t>(size.z)};
  const auto allocate = [&] { return cudaMalloc3DArray(&array_, &format, texels, cudaArraySurfaceLoadStore); };
  cudaError_t code = allocate();
  if (code == cudaErrorMemoryAllocation) {  // memory that the pool of DeviceArrays keeps for reuse may suffice
    cudaGetLastError();
    free_device_bytes(~std::uint64_t{0});
    code = allocate();
  }
  check_cuda(code, cat("allocating a texture of ", extent, " voxels, ", format_bytes(bytes())), bytes());
  cudaResourceDesc resource{};
  resource.resType = cudaResourceTypeArray;
  resource.res.array.array = array_;
  cudaTextureDesc how{};
  for (cudaTextureAddressMode& mode : how.addressMode) mode = cudaAddressModeClamp;
  how.filterMode = cudaFilterModeLinear;
  how.readMode = type == TexelType::float32 ? cudaReadModeElementType : cudaReadModeNormalizedFloat;
  check_cuda(cudaCreateTextureObject(&texture_, &resource, &how, nullptr), "making a texture");
  check_cuda(cudaCreateSurfaceObject(&surface_, &resource), "making a surface");
}

Texture::~Texture() {
  if (texture_ != 0) cudaDestroyTextureObject(texture_);
  if (surface_ != 0) cudaDestroySurfaceObject(surface_);
  if (array_ != nullptr) cudaFreeArray(array_);
}

Texture::Texture(Texture&& other) noexcept { *this = std::move(other); }

Texture& Texture::operator=(Texture&& other) noexcept {
  std::swap(size_, other.size_);
  std::swap(type_, other.type_);
  std::swap(array_, other.array_);
  std::swap(texture_, other.texture_);
  std::swap(surface_, other.surface_);
  return *this;
}

std::uint64_t Texture::bytes() const {
  return static_cast<std::uint64_t>(size_.x) * static_cast<std::uint64_t>(size_.y) *
         static_cast<std::uint64_t>(size_.z) * texel_bytes(type_);
}

void Texture::upload(const float* planes, std::int32_t z, std::int32_t depth) {
  const auto width = static_cast<std::size_t>(size_.x);
  const auto height = static_cast<std::size_t>(size_.y);
  cudaMemcpy3DParms copy{};
  copy.srcPtr = make_cudaPitchedPtr(const_cast<float*>(planes), width * sizeof(float), width, height);
  copy.extent = {width, height, static_cast<std::size_t>(depth)};
  copy.dstArray = array_;
  copy.dstPos.z = static_cast<std::size_t>(z);
  copy.kind = cudaMemcpyHostToDevice;
  check_cuda(cudaMemcpy3D(&copy), "copying planes to a texture");
}

}  // namespace weir
