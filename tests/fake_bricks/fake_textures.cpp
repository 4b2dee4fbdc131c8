// The functions of the CUDA runtime for arrays, textures and surfaces, for a program that does not link it.
#include <cuda_runtime_api.h>

#include <cstdint>
#include <cstdlib>
#include <new>

#include "tests/fake_cuda/fake_array.h"
#include "tests/fake_cuda/fake_runtime.h"

using weir::test::FakeArray;
using weir::test::FakeRuntime;
using weir::test::FakeView;

namespace {

cudaError_t give_back(void* memory) {
  if (memory == nullptr) return cudaSuccess;
  if (!FakeRuntime::instance().freed(reinterpret_cast<std::uintptr_t>(memory))) return cudaErrorInvalidValue;
  std::free(memory);
  return cudaSuccess;
}

cudaError_t make_view(unsigned long long* object, const cudaResourceDesc* resource, const char* function) {
  if (const cudaError_t code = FakeRuntime::instance().enter_allocation(function, sizeof(FakeView));
      code != cudaSuccess)
    return code;
  void* const memory = std::malloc(sizeof(FakeView));
  new (memory) FakeView{reinterpret_cast<FakeArray*>(resource->res.array.array)};
  FakeRuntime::instance().allocated(reinterpret_cast<std::uintptr_t>(memory), sizeof(FakeView));
  *object = reinterpret_cast<unsigned long long>(memory);
  return cudaSuccess;
}

}  // namespace

extern "C" {

cudaError_t cudaMalloc3DArray(cudaArray_t* array, const cudaChannelFormatDesc* format, cudaExtent extent, unsigned) {
  const FakeArray made{extent.width, extent.height, extent.depth, static_cast<std::size_t>(format->x) / 8};
  if (const cudaError_t code = FakeRuntime::instance().enter_allocation("cudaMalloc3DArray", made.bytes());
      code != cudaSuccess) {
    return code;
  }
  void* const memory = std::malloc(sizeof made + made.bytes());
  new (memory) FakeArray(made);
  FakeRuntime::instance().allocated(reinterpret_cast<std::uintptr_t>(memory), made.bytes());
  *array = static_cast<cudaArray_t>(memory);
  return cudaSuccess;
}
cudaError_t cudaFreeArray(cudaArray_t array) { return give_back(array); }
cudaError_t cudaCreateTextureObject(cudaTextureObject_t* object, const cudaResourceDesc* resource,
                                    const cudaTextureDesc*, const cudaResourceViewDesc*) {
  return make_view(object, resource, "cudaCreateTextureObject");
}
cudaError_t cudaDestroyTextureObject(cudaTextureObject_t object) { return give_back(reinterpret_cast<void*>(object)); }
cudaError_t cudaCreateSurfaceObject(cudaSurfaceObject_t* object, const cudaResourceDesc* resource) {
  return make_view(object, resource, "cudaCreateSurfaceObject");
}
cudaError_t cudaDestroySurfaceObject(cudaSurfaceObject_t object) { return give_back(reinterpret_cast<void*>(object)); }
cudaError_t cudaMemcpy3D(const cudaMemcpy3DParms*) { return FakeRuntime::instance().enter("cudaMemcpy3D"); }
cudaChannelFormatDesc cudaCreateChannelDesc(int x, int y, int z, int w, cudaChannelFormatKind kind) {
  return {x, y, z, w, kind};
}

}  // extern "C"
