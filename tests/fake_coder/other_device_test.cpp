// Work on the second of two pretended devices makes no context on the first, and leaves threads as it found them.
#include <cuda_runtime_api.h>
#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <thread>
#include <vector>

#include "bindings/cuda/device_array_source.h"
#include "compressor/push/resident_source.h"
#include "gpu/cuda/encode/device_coder.h"
#include "gpu/cuda/encode/pinned_pool.h"
#include "gpu/cuda/encode/resident_volume.h"
#include "gpu/cuda/push/device_slabs.h"
#include "gpu/cuda/push/resident_planes.h"
#include "gpu/cuda/runtime/current_device.h"
#include "tests/fake_coder/support.h"
#include "tests/fake_cuda/fake_runtime.h"

namespace weir::fake_coder_test {
namespace {

using test::FakeRuntime;
using test::MemoryVolume;

void fail_test(const Error& error) { ADD_FAILURE() << error.what(); }

class OtherDevice : public testing::Test {
 protected:
  OtherDevice() {
    PinnedPool::of_process().clear();
    runtime().reset();
    runtime().set_devices(2);
  }
  ~OtherDevice() override { runtime().reset(); }

  static FakeRuntime& runtime() { return FakeRuntime::instance(); }

  // Runs `call` on a thread that has no context.
  template <class Call>
  static void elsewhere(const Call& call) {
    std::thread([&] {
      call();
      EXPECT_EQ(runtime().context(), 0U) << "the thread has none still";
    }).join();
  }

  // Runs `call` on a thread in a context that the thread made itself.
  template <class Call>
  static void in_own_context(const Call& call) {
    std::thread([&] {
      runtime().make_current(FakeRuntime::own_context(1));
      call();
      EXPECT_EQ(runtime().current_context(), FakeRuntime::own_context(1));
    }).join();
  }

  static ConversionOptions options() {
    ConversionOptions options = with(budget_of(Budget::Kind::rate, 6));
    options.resume = Resume::off;
    options.threads = 3;
    return options;
  }
};

using Devices = std::set<int>;

TEST_F(OtherDevice, AThreadWithoutAContextGetsNone) {
  elsewhere([] {
    {
      const KeptDevice kept(1);
      EXPECT_EQ(current_device(), 1);
    }
    EXPECT_EQ(current_device(), 0);
  });
  EXPECT_EQ(runtime().devices_in_use(), Devices{1});
}

TEST_F(OtherDevice, TheContextOfTheCallerIsCurrentAgain) {
  runtime().choose(0);
  const std::uint64_t before = runtime().context();
  {
    const KeptDevice kept(1);
    EXPECT_NE(runtime().context(), before);
  }
  EXPECT_EQ(runtime().context(), before);
  free_on(1, [&] { EXPECT_EQ(current_device(), 1); });
  EXPECT_EQ(runtime().context(), before);
}

TEST_F(OtherDevice, ContextThatTheCallerMade_AllThreadsCodeInIt) {
  const std::vector<float> values(512, 1.0F);
  const Box block{{0, 0, 0}, {8, 8, 8}};
  std::unique_ptr<BlockCoder> coder;
  in_own_context([&] {
    coder = make_device_coder(1, fail_test);
    EXPECT_NE(coder->load(values, block, block), nullptr);
  });
  elsewhere([&] { EXPECT_NE(coder->load(values, block, block), nullptr); });
  elsewhere([&] { coder.reset(); });
  EXPECT_EQ(runtime().devices_in_use(), Devices{}) << "the runtime's context is another one";
}

TEST_F(OtherDevice, ContextThatTheCallerMade_AllThreadsReadInIt) {
  MemoryVolume volume = turbulence();
  DenseArray array;
  array.data = volume.values().data();
  array.extent = volume.info().extent;
  array.stride = packed_stride(array.extent, array.type);
  std::unique_ptr<VolumeSource> source;
  std::unique_ptr<ResidentPlanes> planes;
  in_own_context([&] {
    source = open_device_array(array, 1);
    planes = std::make_unique<ResidentPlanes>(Index3{8, 8, 8});
  });
  elsewhere([&] {
    float value = 0;
    source->read({{4, 2, 0}, {5, 3, 1}}, {&value, 1});
    EXPECT_EQ(value, volume.values()[static_cast<std::size_t>(linear_index({4, 2, 0}, array.extent))]);
    planes->add({0, 0, 0}, &value, 1);
    EXPECT_EQ(*planes->values(), value);
    planes->finish();
  });
  elsewhere([&] {
    source.reset();
    planes.reset();
  });
  EXPECT_EQ(runtime().devices_in_use(), Devices{});
}

TEST_F(OtherDevice, HoldsItsContextOnceAndWhoeverElseLetsGo) {
  runtime().retain(1);  // held by another library
  elsewhere([] {
    for (int i = 0; i < 5; ++i) const KeptDevice kept(1);
  });
  EXPECT_EQ(runtime().references(1), 2);
  runtime().release(1);
  EXPECT_EQ(runtime().devices_in_use(), Devices{1});
}

TEST_F(OtherDevice, FreesWhatThereIsWhereTheDeviceIsGone) {
  bool freed = false;
  free_on(2, [&] { freed = true; });
  EXPECT_TRUE(freed);
}

TEST_F(OtherDevice, EncodesFilesThatTheHostHas) {
  MemoryVolume volume = cloud();
  const Result expected = convert_by(nullptr, volume, options());
  elsewhere([&] {
    const std::unique_ptr<BlockCoder> coder = make_device_coder(1, fail_test);
    const Result result = convert_by(coder.get(), volume, options());
    EXPECT_EQ(result.file == expected.file, true);
  });
  EXPECT_GT(runtime().calls("cudaHostAlloc"), 0U);
  EXPECT_EQ(runtime().devices_in_use(), Devices{1});
  elsewhere([] { PinnedPool::of_process().clear(); });
  EXPECT_EQ(runtime().devices_in_use(), Devices{1});
  EXPECT_EQ(runtime().allocated_bytes(), 0U);
}

TEST_F(OtherDevice, EncodesVolumesThatLieThere) {
  MemoryVolume volume = turbulence();
  const Result expected = convert_by(nullptr, volume, options());
  elsewhere([&] {
    const std::unique_ptr<VolumeSource> source = open_resident(
        make_resident_volume(1, volume.values().data(), volume.info().domain(), fail_test), volume.info());
    const Result result = convert_by(nullptr, *source, options());
    EXPECT_EQ(result.file == expected.file, true);
  });
  EXPECT_GT(runtime().calls("cudaHostAlloc"), 0U);
  EXPECT_EQ(runtime().devices_in_use(), Devices{1});
}

TEST_F(OtherDevice, ReadsArraysThatLieThere) {
  MemoryVolume volume = cloud();
  DenseArray array;
  array.data = volume.values().data();
  array.extent = volume.info().extent;
  array.stride = packed_stride(array.extent, array.type);
  const Result expected = convert_by(nullptr, *open_array(array), options());
  elsewhere([&] {
    const Result result = convert_by(nullptr, *open_device_array(array, 1), options());
    EXPECT_EQ(result.file == expected.file, true);
  });
  EXPECT_EQ(runtime().devices_in_use(), Devices{1});
}

TEST_F(OtherDevice, FreesSlabsOnAnyThread) {
  std::unique_ptr<DeviceSlabs> slabs;
  std::thread([&] {
    runtime().choose(1);
    slabs = std::make_unique<DeviceSlabs>(Index3{8, 8, 8}, sizeof(float), 1024,
                                          [](std::int64_t, std::int64_t, const std::byte*) {});
  }).join();
  elsewhere([&] { slabs.reset(); });
  EXPECT_EQ(runtime().devices_in_use(), Devices{1});
  EXPECT_EQ(runtime().allocated_bytes(), 0U);
}

}  // namespace
}  // namespace weir::fake_coder_test
