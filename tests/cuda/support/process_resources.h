// What a process holds of its system and its device; used to find leaks.
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "gpu/cuda/runtime/check.h"

namespace weir::test {

/// Returns the status value of "VmLck", "VmPin" or "VmRSS" in KiB.
inline std::uint64_t status_kib(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(key + ":")) return std::strtoull(line.c_str() + key.size() + 1, nullptr, 10);
  }
  return 0;
}

inline auto open_descriptors() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), std::filesystem::directory_iterator());
}

/// Returns the number of mappings of files with `path` in their paths.
inline int mappings_of(std::string_view path) {
  std::ifstream maps("/proc/self/maps");
  int found = 0;
  for (std::string line; std::getline(maps, line);) found += line.find(path) == std::string::npos ? 0 : 1;
  return found;
}

/// Returns the bytes of the current device that any process uses, after its pool has given back what it keeps for
/// reuse.
inline std::size_t used_device_bytes() {
  check_cuda(cudaDeviceSynchronize(), "test");
  cudaMemPool_t pool = nullptr;
  check_cuda(cudaDeviceGetDefaultMemPool(&pool, 0), "test");
  check_cuda(cudaMemPoolTrimTo(pool, 0), "test");
  std::size_t free = 0;
  std::size_t total = 0;
  check_cuda(cudaMemGetInfo(&free, &total), "test");
  return total - free;
}

/// Returns the allocated bytes of the current device's pool.
inline std::uint64_t pool_bytes() {
  cudaMemPool_t pool = nullptr;
  std::uint64_t bytes = 0;
  check_cuda(cudaDeviceSynchronize(), "test");
  check_cuda(cudaDeviceGetDefaultMemPool(&pool, 0), "test");
  check_cuda(cudaMemPoolGetAttribute(pool, cudaMemPoolAttrUsedMemCurrent, &bytes), "test");
  return bytes;
}

}  // namespace weir::test
