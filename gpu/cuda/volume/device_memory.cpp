#include "gpu/cuda/volume/device_memory.h"

#include <cuda_runtime_api.h>

#include "gpu/cuda/runtime/check.h"

namespace weir {

namespace {

struct MemoryInfo {
  std::size_t free = 0;
  std::size_t total = 0;
};

MemoryInfo memory_now() {
  MemoryInfo info;
  check_cuda(cudaMemGetInfo(&info.free, &info.total), "asking for the device's memory");
  return info;
}

}  // namespace

std::uint64_t free_device_bytes(std::uint64_t wanted) {
  if (const std::uint64_t free = memory_now().free; free >= wanted) return free;
  int device = 0;
  cudaMemPool_t pool = nullptr;
  check_cuda(cudaGetDevice(&device), "asking for the current device");
  check_cuda(cudaDeviceGetDefaultMemPool(&pool, device), "asking for the device's memory pool");
  check_cuda(cudaDeviceSynchronize(), "waiting for the device");
  check_cuda(cudaMemPoolTrimTo(pool, 0), "emptying the device's memory pool");
  return memory_now().free;
}

std::uint64_t device_bytes() { return memory_now().total; }

}  // namespace weir
