// Slabs from the memory of a pretended device: which pieces arrive, in what memory, and what failures do.
#include "gpu/cuda/push/device_slabs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "tests/fake_cuda/fake_runtime.h"

namespace weir::device_slabs_test {
namespace {

using test::FakeRuntime;

constexpr Index3 kExtent{300, 200, 90};  // planes of 240,000 bytes; 34 fit into 8 MiB
constexpr std::int64_t kPlane = kExtent.x * kExtent.y;
constexpr std::uint64_t kPlaneBytes = kPlane * sizeof(float);

class DeviceSlabsTest : public testing::Test {
 protected:
  DeviceSlabsTest() : values_(kPlane * kExtent.z), arrived_(values_.size(), -1.0F) {
    runtime().reset();
    std::iota(values_.begin(), values_.end(), 0.0F);
  }
  ~DeviceSlabsTest() override {
    EXPECT_EQ(runtime().allocated_bytes(), 0U);
    runtime().reset();
  }

  static FakeRuntime& runtime() { return FakeRuntime::instance(); }

  DeviceSlabs::Arrived keep() {
    return [this](std::int64_t z0, std::int64_t nz, const std::byte* values) {
      std::memcpy(arrived_.data() + z0 * kPlane, values, static_cast<std::size_t>(nz) * kPlaneBytes);
      most_planes_ = std::max(most_planes_, nz);
    };
  }

  DeviceValues from(std::int64_t z0) const {
    return {reinterpret_cast<const std::byte*>(values_.data() + z0 * kPlane),
            {4, 4 * kExtent.x, static_cast<std::int64_t>(kPlaneBytes)},
            4};
  }

  std::string refusal(const std::function<void()>& call, ErrorKind kind) const {
    try {
      call();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), kind) << error.what();
      return error.what();
    }
    return "none";
  }

  std::vector<float> values_;
  std::vector<float> arrived_;
  std::int64_t most_planes_ = 0;
};

TEST_F(DeviceSlabsTest, ArriveInPiecesOfWholePlanesThroughBoundedPinnedMemory) {
  DeviceSlabs slabs(kExtent, 4, 0, keep());
  EXPECT_LE(runtime().allocated_bytes(), DeviceSlabs::kPinnedSlots * DeviceSlabs::kPieceBytes + 64);
  slabs.add(50, 40, from(50), nullptr);
  slabs.add(0, 50, from(0), nullptr);
  slabs.finish();
  EXPECT_EQ(arrived_, values_);
  EXPECT_EQ(most_planes_, 34);
}

TEST_F(DeviceSlabsTest, NullStream_IsTheCallersDefaultStreamNotTheThreadsOwn) {
  DeviceSlabs slabs(kExtent, 4, 0, keep());
  slabs.add(0, 90, from(0), nullptr);
  slabs.finish();
  EXPECT_EQ(runtime().streams_named(), std::set<cudaStream_t>{cudaStreamLegacy});
}

TEST_F(DeviceSlabsTest, WaitInTheDeviceMemoryThatWasGranted) {
  constexpr std::uint64_t kGranted = 5 * kPlaneBytes;
  DeviceSlabs slabs(kExtent, 4, kGranted, keep());
  // Two pieces of two planes on the device and one on the host, and two events of one byte each.
  EXPECT_EQ(runtime().allocated_bytes(), 6 * kPlaneBytes + 2);
  slabs.add(0, 90, from(0), nullptr);
  slabs.finish();
  EXPECT_EQ(arrived_, values_);
  EXPECT_EQ(most_planes_, 2);
}

TEST_F(DeviceSlabsTest, ContextThatTheCallerMade_CrossTheBusInIt) {
  runtime().make_current(FakeRuntime::own_context(0));
  {
    DeviceSlabs slabs(kExtent, 4, 5 * kPlaneBytes, keep());
    slabs.add(0, 90, from(0), nullptr);
    slabs.finish();
  }
  EXPECT_EQ(arrived_, values_);
  EXPECT_EQ(runtime().devices_in_use(), std::set<int>{}) << "the runtime's context is another one";
}

TEST_F(DeviceSlabsTest, AnyStridesAndSlabsInAnyOrder) {
  const Index3 extent{7, 5, 6};
  std::vector<std::int16_t> transposed(7 * 5 * 6);  // z fastest, x slowest, each row backwards
  const auto at = [](std::int64_t x, std::int64_t y, std::int64_t z) { return z + 6 * (4 - y + 5 * x); };
  std::vector<std::int16_t> expected;
  for (std::int64_t z = 0; z < 6; ++z) {
    for (std::int64_t y = 0; y < 5; ++y) {
      for (std::int64_t x = 0; x < 7; ++x) {
        expected.push_back(static_cast<std::int16_t>(100 * x + 10 * y + z));
        transposed[static_cast<std::size_t>(at(x, y, z))] = expected.back();
      }
    }
  }
  std::vector<std::int16_t> arrived(expected.size());
  DeviceSlabs slabs(extent, 2, 0, [&](std::int64_t z0, std::int64_t nz, const std::byte* values) {
    std::memcpy(arrived.data() + z0 * 35, values, static_cast<std::size_t>(nz) * 70);
  });
  for (const std::int64_t z : {4, 0, 2}) {
    slabs.add(z, 2,
              {reinterpret_cast<const std::byte*>(&transposed[static_cast<std::size_t>(at(0, 0, z))]), {60, -12, 2}, 2},
              nullptr);
  }
  slabs.finish();
  EXPECT_EQ(arrived, expected);
}

TEST_F(DeviceSlabsTest, RefusesWhatAKernelCannotReadAndTooLittleMemory) {
  EXPECT_EQ(refusal([&] { DeviceSlabs(kExtent, 4, kPlaneBytes - 1, keep()); }, ErrorKind::usage),
            "the device memory for slabs is 239999 bytes, and a plane has 240000; give as much or more, or 0 for none");
  DeviceSlabs slabs(kExtent, 4, 0, keep());
  DeviceValues odd = from(0);
  odd.first += 2;
  const std::string message =
      "on a device, the address and the strides of values must be multiples of the 4 bytes of a value";
  EXPECT_EQ(refusal([&] { slabs.add(0, 1, odd, nullptr); }, ErrorKind::usage), message);
  odd = from(0);
  odd.stride[1] = 1202;
  EXPECT_EQ(refusal([&] { slabs.add(0, 1, odd, nullptr); }, ErrorKind::usage), message);
  slabs.add(0, 90, from(0), nullptr);  // the work continues
  slabs.finish();
  EXPECT_EQ(arrived_, values_);
}

TEST_F(DeviceSlabsTest, AFailedCopyEndsThemWithItsMessage) {
  for (const char* function : {"cudaMemcpyAsync", "cudaEventSynchronize", "cudaEventRecord"}) {
    SCOPED_TRACE(function);
    DeviceSlabs slabs(kExtent, 4, 0, keep());
    runtime().fail(function, 1, cudaErrorIllegalAddress);
    const auto push = [&] {
      slabs.add(0, 90, from(0), nullptr);
      slabs.finish();
    };
    const std::string message = refusal(push, ErrorKind::io);
    EXPECT_NE(message.find(": cudaErrorIllegalAddress, pretended"), std::string::npos) << message;
    EXPECT_EQ(refusal([&] { slabs.add(0, 1, from(0), nullptr); }, ErrorKind::io), message);
    EXPECT_EQ(refusal([&] { slabs.finish(); }, ErrorKind::io), message);
  }
}

TEST_F(DeviceSlabsTest, NoRoomIsAnErrorThatLeavesNothing) {
  runtime().fail("cudaHostAlloc", 0, cudaErrorMemoryAllocation);
  EXPECT_EQ(
      refusal([&] { DeviceSlabs(kExtent, 4, 0, keep()); }, ErrorKind::io),
      "slabs cross the bus through memory that is locked: page-locking 23.3 MiB of host memory: "
      "cudaErrorMemoryAllocation, pretended; allow more (ulimit -l), free some, or push the values from host memory");
  runtime().fail("cudaMallocAsync", 0, cudaErrorMemoryAllocation);
  EXPECT_EQ(refusal([&] { DeviceSlabs(kExtent, 4, 5 * kPlaneBytes, keep()); }, ErrorKind::io),
            "allocating 937.5 KiB of device memory: cudaErrorMemoryAllocation, pretended");
}

TEST_F(DeviceSlabsTest, AnExceptionOfWhoTakesThemEndsThem) {
  std::atomic<int> calls{0};
  DeviceSlabs slabs(kExtent, 4, 0, [&](std::int64_t, std::int64_t, const std::byte*) {
    ++calls;
    throw Error(ErrorKind::io, "the disk is full");
  });
  const auto push = [&] {
    slabs.add(0, 90, from(0), nullptr);
    slabs.finish();
  };
  EXPECT_EQ(refusal(push, ErrorKind::io), "the disk is full");
  EXPECT_EQ(refusal(push, ErrorKind::io), "the disk is full");
  EXPECT_EQ(calls, 1);
}

}  // namespace
}  // namespace weir::device_slabs_test
