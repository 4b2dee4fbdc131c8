// Callers' values on a pretended device: where they are, and whether they have gaps.
#include "gpu/cuda/push/device_values.h"

#include <gtest/gtest.h>

#include <cstddef>

#include "tests/fake_cuda/fake_runtime.h"
#include "tests/support/message_of_error.h"

namespace weir::device_values_test {
namespace {

class DeviceValuesTest : public testing::Test {
 protected:
  DeviceValuesTest() { runtime().reset(); }
  ~DeviceValuesTest() override { runtime().reset(); }

  static test::FakeRuntime& runtime() { return test::FakeRuntime::instance(); }
};

TEST_F(DeviceValuesTest, Place_IsThatOfDeviceMemoryAndNoneOfTheHosts) {
  void* device = nullptr;
  ASSERT_EQ(cudaMallocAsync(&device, 100, nullptr), cudaSuccess);
  const std::byte* const last = static_cast<const std::byte*>(device) + 99;
  ASSERT_TRUE(device_place(last));
  EXPECT_EQ(device_place(last)->device, 0);
  EXPECT_TRUE(is_device_memory(last));
  EXPECT_TRUE(lies_on(last, 0));
  EXPECT_FALSE(lies_on(last, 1));
  const std::byte host{};
  EXPECT_FALSE(device_place(&host));
  EXPECT_FALSE(lies_on(&host, 0));
  ASSERT_EQ(cudaFreeAsync(device, nullptr), cudaSuccess);
}

TEST_F(DeviceValuesTest, Place_IsNoneWhereThereIsNoDevice) {
  runtime().set_devices(0);
  const std::byte host{};
  EXPECT_FALSE(device_place(&host));
  EXPECT_EQ(runtime().calls("cudaPointerGetAttributes"), 0U);
}

TEST_F(DeviceValuesTest, Gaps_AreSeenAlongEachAxis) {
  const Index3 extent{3, 4, 5};
  EXPECT_TRUE(without_gaps({nullptr, {4, 12, 48}, 4}, extent));
  EXPECT_FALSE(without_gaps({nullptr, {8, 12, 48}, 4}, extent));
  EXPECT_FALSE(without_gaps({nullptr, {4, 16, 48}, 4}, extent));
  EXPECT_FALSE(without_gaps({nullptr, {4, 12, 52}, 4}, extent));
  EXPECT_TRUE(without_gaps({nullptr, {4, 12, 52}, 4}, {3, 4, 1})) << "one plane has no next";
}

TEST_F(DeviceValuesTest, Reach_OfAKernelIsItsOwnDeviceAndManagedMemory) {
  const Index3 extent{3, 4, 5};
  const DeviceValues packed{nullptr, {4, 12, 48}, 4};
  const DeviceValues strided{nullptr, {8, 24, 96}, 4};
  runtime().set_devices(2);
  check_reach(strided, extent, {.device = 0, .managed = false});
  check_reach(strided, extent, {.device = 1, .managed = true});
  check_reach(packed, extent, {.device = 1, .managed = false});
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { check_reach(strided, extent, {.device = 1, .managed = false}); }),
            "values lie on device 1, and device 0 is current, which can copy them only where there are no gaps between "
            "them; make the other one current, or copy them together first");
}

}  // namespace
}  // namespace weir::device_values_test
