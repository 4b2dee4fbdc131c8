// Kernels read a grid that stays in host memory.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "gpu/cuda/grid_loader.h"
#include "gpu/cuda/runtime/check.h"
#include "gpu/cuda/runtime/device_array.h"
#include "tests/cuda/support/grid_file.h"
#include "tests/support/temporary_directory.h"

namespace weir {
namespace {

/// Adds every byte, multiplied by its position modulo 251, to `sum`.
__global__ void weigh_bytes(const std::byte* bytes, std::uint64_t count, unsigned long long* sum) {
  unsigned long long mine = 0;
  const std::uint64_t stride = std::uint64_t{gridDim.x} * blockDim.x;
  for (std::uint64_t i = std::uint64_t{blockIdx.x} * blockDim.x + threadIdx.x; i < count; i += stride) {
    mine += static_cast<unsigned long long>(bytes[i]) * (i % 251);
  }
  atomicAdd(sum, mine);
}

TEST(ZeroCopyKernel, ReadsEveryByteOfTheGrid) {
  if (device_count() == 0) GTEST_SKIP() << "no CUDA device";
  const TemporaryDirectory directory;
  for (const test::GridFileOptions& layout : {test::GridFileOptions{4096, 0}, test::GridFileOptions{333, 77}}) {
    const std::string path = directory / "grid.nvdb";
    test::write_grid_file(path, 64, layout);
    const NvdbFile file(path);
    unsigned long long expected = 0;
    std::uint64_t place = 0;
    for (const std::byte byte : file.grid().data()) expected += static_cast<unsigned long long>(byte) * (place++ % 251);

    const DeviceGrid grid = load_grid(file, {}, {.zero_copy = true});
    DeviceArray<unsigned long long> sum(1);
    sum.upload(std::vector<unsigned long long>{0});
    weigh_bytes<<<64, 256>>>(grid.data(), grid.bytes(), sum.data());
    check_cuda(cudaGetLastError(), "starting a kernel");
    EXPECT_EQ(sum.download().front(), expected);
  }
}

}  // namespace
}  // namespace weir
