// What a calling program has left in its thread: work in its default stream, and an error that it has handled.
#include <cuda_runtime_api.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <fstream>
#include <string>
#include <thread>

#include "gpu/cuda/expand/expanded_grid.h"
#include "gpu/cuda/grid_loader.h"
#include "tests/cuda/support/device_reads.h"
#include "tests/cuda/support/grid_file.h"
#include "tests/support/packed_sample.h"
#include "tests/support/temporary_directory.h"

namespace weir::caller_state_test {
namespace {

class CallerState : public testing::Test {
 protected:
  void SetUp() override { WEIR_NEEDS_DEVICE(); }

  const TemporaryDirectory directory_;
  const std::string path_ = directory_ / "a.nvdb";
};

void sleep_and_set(void* flag) {
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  *static_cast<std::atomic<bool>*>(flag) = true;
}

TEST_F(CallerState, NullStream_ALoadWaitsForWorkInTheDefaultStream) {
  test::write_grid_file(path_, 40);
  const NvdbFile file(path_);
  DeviceBuffer buffer = load_grid(file, {}).take_buffer();
  for (const cudaStream_t queued : {cudaStreamLegacy, cudaStreamPerThread}) {
    std::atomic<bool> done{false};
    ASSERT_EQ(cudaLaunchHostFunc(queued, sleep_and_set, &done), cudaSuccess);
    DeviceGrid grid = load_grid(file, std::move(buffer));
    EXPECT_TRUE(done) << "a kernel there may still read what the buffer held";
    buffer = std::move(grid).take_buffer();
    ASSERT_EQ(cudaDeviceSynchronize(), cudaSuccess);
  }
}

TEST_F(CallerState, OlderError_IsNotTakenForAKernelThatDidNotStart) {
  const test::PackedFile made = test::PackedSample::build();
  std::ofstream(path_, std::ios::binary)
      .write(reinterpret_cast<const char*>(made.file.data()), static_cast<std::streamsize>(made.file.size()));
  const NvdbFile file(path_);
  void* refused = nullptr;
  ASSERT_EQ(cudaMalloc(&refused, std::size_t{1} << 60U), cudaErrorMemoryAllocation);
  const DeviceGrid grid = load_grid_as(file, GridType::float32, {});
  EXPECT_GT(grid.bytes(), 0U);
  cudaGetLastError();
}

}  // namespace
}  // namespace weir::caller_state_test
