#include "gpu/cuda/volume/device_memory.h"

#include <cuda_runtime_api.h>
#include <gtest/gtest.h>

#include <limits>

#include "gpu/cuda/render/cuda_backend.h"
#include "gpu/cuda/runtime/device_array.h"
#include "tests/cuda/support/device_reads.h"

namespace weir::device_memory_test {
namespace {

constexpr std::uint64_t kMuch = 1ULL << 30U;

// The pool of a back end keeps the memory that is given back to it.
TEST(FreeDeviceBytes, ReleasesThePoolsReserveWhenItIsWanted) {
  WEIR_NEEDS_DEVICE();
  const auto backend = make_cuda_backend({});
  constexpr std::uint64_t kAll = std::numeric_limits<std::uint64_t>::max();
  const std::uint64_t before = free_device_bytes(kAll);
  { const DeviceArray<std::byte> much(kMuch); }
  EXPECT_LE(free_device_bytes(0) + kMuch, before);
  EXPECT_EQ(free_device_bytes(before), before);
}

std::uint64_t kept_by_pool() {
  cudaMemPool_t pool = nullptr;
  std::uint64_t bytes = 0;
  EXPECT_EQ(cudaDeviceGetDefaultMemPool(&pool, 0), cudaSuccess);
  EXPECT_EQ(cudaMemPoolGetAttribute(pool, cudaMemPoolAttrReleaseThreshold, &bytes), cudaSuccess);
  return bytes;
}

TEST(KeptMemory, TheLastOneLeavesThePoolAsTheProgramHadIt) {
  WEIR_NEEDS_DEVICE();
  const std::uint64_t before = kept_by_pool();
  auto first = make_cuda_backend({});
  auto second = make_cuda_backend({});
  EXPECT_EQ(kept_by_pool(), std::numeric_limits<std::uint64_t>::max());
  first.reset();
  EXPECT_EQ(kept_by_pool(), std::numeric_limits<std::uint64_t>::max());
  second.reset();
  EXPECT_EQ(kept_by_pool(), before);
}

}  // namespace
}  // namespace weir::device_memory_test
