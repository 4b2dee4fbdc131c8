#include "gpu/cuda/volume/device_memory.h"

#include <cuda_runtime_api.h>

#include <map>
#include <mutex>

#include "gpu/cuda/runtime/check.h"
#include "gpu/cuda/runtime/current_device.h"

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

/// For a device: the number of KeptMemory objects, and the bytes that its pool kept before them.
struct Kept {
  int users = 0;
  std::uint64_t before = 0;
};
std::mutex kept_mutex;
std::map<int, Kept> kept_of_devices;

cudaMemPool_t default_pool(int device) {
  cudaMemPool_t pool = nullptr;
  check_cuda(cudaDeviceGetDefaultMemPool(&pool, device), "asking for the device's memory pool");
  return pool;
}

}  // namespace

std::uint64_t free_device_bytes(std::uint64_t wanted) {
  if (const std::uint64_t free = memory_now().free; free >= wanted) return free;
  const int device = existing_current_device();
  check_cuda(cudaDeviceSynchronize(), "waiting for the device");
  check_cuda(cudaMemPoolTrimTo(default_pool(device), 0), "emptying the device's memory pool");
  return memory_now().free;
}

std::uint64_t device_bytes() { return memory_now().total; }

KeptMemory::KeptMemory(int device) : device_(device) {
  const std::lock_guard lock(kept_mutex);
  Kept& kept = kept_of_devices[device];
  if (kept.users == 0) {
    cudaMemPool_t const pool = default_pool(device);
    std::uint64_t all = ~std::uint64_t{0};
    check_cuda(cudaMemPoolGetAttribute(pool, cudaMemPoolAttrReleaseThreshold, &kept.before),
               "asking what the device's memory pool keeps");
    check_cuda(cudaMemPoolSetAttribute(pool, cudaMemPoolAttrReleaseThreshold, &all), "keeping device memory");
  }
  ++kept.users;
}

KeptMemory::~KeptMemory() {
  const std::lock_guard lock(kept_mutex);
  Kept& kept = kept_of_devices[device_];
  if (--kept.users > 0) return;
  // A device that fails has reported this where it was used.
  cudaMemPool_t pool = nullptr;
  if (cudaDeviceGetDefaultMemPool(&pool, device_) != cudaSuccess) return;
  cudaMemPoolSetAttribute(pool, cudaMemPoolAttrReleaseThreshold, &kept.before);
  cudaMemPoolTrimTo(pool, kept.before);
}

}  // namespace weir
