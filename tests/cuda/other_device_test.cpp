// Work on the second device of a machine leaves threads and the first device as they were.
#include <cuda_runtime_api.h>
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "gpu/cuda/encode/device_coder.h"
#include "gpu/cuda/encode/pinned_pool.h"
#include "gpu/cuda/runtime/current_device.h"
#include "gpu/cuda/runtime/device_array.h"
#include "tests/cuda/support/device_reads.h"

namespace weir::other_device_test {
namespace {

class OtherDevice : public testing::Test {
 protected:
  void SetUp() override {
    WEIR_NEEDS_DEVICE();
    if (device_count() < 2) GTEST_SKIP() << "there is one device";
  }
};

TEST_F(OtherDevice, AThreadWithoutAContext_MakesNoneOnTheFirst) {
  const bool used = has_context(0);
  std::thread([] {
    {
      const KeptDevice kept(1);
      EXPECT_EQ(current_device(), 1);
      const DeviceArray<float> values(1024);
    }
    EXPECT_EQ(current_device(), 0);
  }).join();
  EXPECT_TRUE(has_context(1));
  EXPECT_EQ(has_context(0), used);
}

// The driver's count of a context's holders does not grow with the calls, and the context does not end with the first
// holder.
TEST_F(OtherDevice, ContextsStayUntilTheDeviceIsReset) {
  std::thread([] {
    void* const first = primary_context(1);
    EXPECT_EQ(primary_context(1), first);
    EXPECT_TRUE(has_context(1));
    ASSERT_EQ(cudaSetDevice(1), cudaSuccess);
    ASSERT_EQ(cudaDeviceReset(), cudaSuccess);
    EXPECT_FALSE(has_context(1));
    set_current_context(nullptr);
    const KeptDevice kept(1);
    const DeviceArray<float> values(std::vector<float>{1, 2, 3});
    EXPECT_EQ(values.download(), (std::vector<float>{1, 2, 3}));
  }).join();
}

TEST_F(OtherDevice, TheCallersContextIsCurrentAgain) {
  std::thread([] {
    ASSERT_EQ(cudaSetDevice(1), cudaSuccess);
    void* const before = current_context();
    ASSERT_NE(before, nullptr);
    const bool used = has_context(0);
    free_on(0, [] { EXPECT_EQ(current_device(), 0); });
    EXPECT_EQ(current_context(), before);
    EXPECT_EQ(current_device(), 1);
    EXPECT_TRUE(used || has_context(0)) << "what is asked to use it does";
  }).join();
}

TEST_F(OtherDevice, BoxesOfManyThreads_MakeNoContextOnTheFirst) {
  const bool used = has_context(0);
  const Box box{{0, 0, 0}, {64, 64, 64}};
  std::vector<float> values(static_cast<std::size_t>(box.voxels()));
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 977);
  std::thread([&] {
    const auto coder = make_device_coder(1, [](const Error& error) { ADD_FAILURE() << error.what(); });
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i) {
      threads.emplace_back([&] {
        const auto loaded = coder->load(values, box, box);
        ASSERT_NE(loaded, nullptr);
        loaded->begin_survey({});
        EXPECT_TRUE(loaded->end_survey());
      });
    }
    for (std::thread& thread : threads) thread.join();
  }).join();
  PinnedPool::of_process().clear();
  EXPECT_EQ(has_context(0), used);
}

}  // namespace
}  // namespace weir::other_device_test
