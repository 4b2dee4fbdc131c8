// Arrays in device memory as sources, on a pretended device: values, files and errors are those of the same array in
// host memory.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "bindings/cuda/device_array_source.h"
#include "gpu/cuda/push/device_slabs.h"
#include "gpu/cuda/runtime/device_array.h"
#include "tests/fake_coder/support.h"
#include "tests/fake_cuda/fake_runtime.h"
#include "tests/support/message_of_error.h"

namespace weir::fake_coder_test {
namespace {

using test::FakeRuntime;

constexpr Index3 kExtent{70, 45, 33};

// Returns the bytes of values of `type` that are all numbers.
std::vector<std::byte> some_values(ScalarType type, std::int64_t count) {
  const std::size_t bytes = scalar_bytes(type);
  std::vector<std::byte> values(static_cast<std::size_t>(count) * bytes);
  for (std::int64_t i = 0; i < count; ++i) {
    const double value = std::floor(90 * waves(index_at(i, kExtent), 6));
    const auto put = [&](auto number) {
      std::memcpy(values.data() + static_cast<std::size_t>(i) * bytes, &number, bytes);
    };
    switch (type) {
      case ScalarType::int16:
        put(static_cast<std::int16_t>(value));
        break;
      case ScalarType::uint8:
        put(static_cast<std::uint8_t>(static_cast<int>(value) & 0xFF));
        break;
      case ScalarType::float64:
        put(value);
        break;
      default:
        put(static_cast<float>(value));
    }
  }
  return values;
}

// The same array in host memory and on the device.
struct Both {
  Both(ScalarType type, const Index3& extent, std::array<std::int64_t, 3> stride, std::int64_t first = 0)
      : host(some_values(type, volume(kExtent))), device(host.size()) {
    device.upload(host);
    in_host.type = in_device.type = type;
    in_host.extent = in_device.extent = extent;
    in_host.stride = in_device.stride = stride;
    in_host.data = host.data() + first;
    in_device.data = device.data() + first;
  }
  std::vector<std::byte> host;
  DeviceArray<std::byte> device;
  DenseArray in_host;
  DenseArray in_device;
};

class DeviceArraySource : public testing::Test {
 protected:
  DeviceArraySource() { runtime().reset(); }
  ~DeviceArraySource() override { runtime().reset(); }
  static FakeRuntime& runtime() { return FakeRuntime::instance(); }

  static void expect_same_boxes(const Both& both) {
    const auto host = open_array(both.in_host);
    const auto device = open_device_array(both.in_device, 0);
    std::mt19937 random(7);
    const Index3 extent = both.in_host.extent;
    const auto within = [&](std::int64_t end) {
      return static_cast<std::int64_t>(random() % static_cast<std::uint32_t>(end));
    };
    for (int trial = 0; trial < 60; ++trial) {
      const Index3 lo{within(extent.x), within(extent.y), within(extent.z)};
      const Index3 most = extent - lo;
      const Box box{lo, lo + Index3{1 + within(most.x), 1 + within(most.y), 1 + within(most.z)}};
      std::vector<float> expected(static_cast<std::size_t>(box.voxels()));
      std::vector<float> found(expected.size());
      host->read(box, expected);
      device->read(box, found);
      ASSERT_EQ(found == expected, true) << "box " << trial;
    }
  }
};

TEST_F(DeviceArraySource, BoxesHaveTheValuesOfTheHost_WhateverTheTypeAndTheStrides) {
  for (const ScalarType type : {ScalarType::uint8, ScalarType::int16, ScalarType::float32, ScalarType::float64}) {
    SCOPED_TRACE(scalar_name(type));
    const auto bytes = static_cast<std::int64_t>(scalar_bytes(type));
    const std::array<std::int64_t, 3> packed = packed_stride(kExtent, type);
    expect_same_boxes({type, kExtent, packed});
    // Every second voxel along x; y backwards from the last row.
    expect_same_boxes(
        {type, {35, kExtent.y, kExtent.z}, {2 * bytes, -packed[1], packed[2]}, (kExtent.y - 1) * packed[1]});
    // z fastest.
    expect_same_boxes({type, {kExtent.z, kExtent.y, kExtent.x}, {packed[2], packed[1], packed[0]}});
  }
}

// Boxes larger than a piece, with planes that are larger than a piece.
TEST_F(DeviceArraySource, BoxesLargerThanAPieceCrossInPieces) {
  const Index3 extent{2100, 1100, 3};
  std::vector<float> values(static_cast<std::size_t>(volume(extent)));
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 9973);
  DeviceArray<float> device(values.size());
  device.upload(values);
  DenseArray array;
  array.data = device.data();
  array.extent = extent;
  array.stride = packed_stride(extent, array.type);
  const auto source = open_device_array(array, 0);
  EXPECT_EQ(source->working_bytes(), DeviceSlabs::kPinnedSlots * DeviceSlabs::kPieceBytes);
  std::vector<float> found(values.size());
  source->read({{0, 0, 0}, extent}, found);
  EXPECT_EQ(found == values, true);
  EXPECT_EQ(source->bytes_read(), values.size() * sizeof(float));
}

TEST_F(DeviceArraySource, FilesHaveTheBytesOfTheHost) {
  for (const ScalarType type : {ScalarType::int16, ScalarType::float32}) {
    const Both both(type, kExtent, packed_stride(kExtent, type));
    ConversionOptions options = with(budget_of(Budget::Kind::rate, 6));
    options.resume = Resume::off;
    const Result expected = convert_by(nullptr, *open_array(both.in_host), options);
    for (const std::size_t threads : {1U, 3U}) {
      options.threads = threads;
      const Result result = convert_by(nullptr, *open_device_array(both.in_device, 0), options);
      EXPECT_EQ(result.file == expected.file, true) << threads << " threads";
      EXPECT_EQ(result.sidecar.source.digest, expected.sidecar.source.digest);
    }
  }
}

TEST_F(DeviceArraySource, WhatIsNoArrayOfADeviceIsRefused) {
  const std::vector<float> host(8);
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { device_of(host.data()); }),
            "source says that it lies on a CUDA device, and its address is no memory of one; give the array itself");
  const Both both(ScalarType::float32, {4, 4, 4}, {6, 16, 64});
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { open_device_array(both.in_device, 0); }),
            "on a device, the address and the strides of values must be multiples of the 4 bytes of a value");
}

TEST_F(DeviceArraySource, AFailedCopyEndsTheConversionAndLeavesNothing) {
  const Both both(ScalarType::float32, kExtent, packed_stride(kExtent, ScalarType::float32));
  const auto source = open_device_array(both.in_device, 0);
  runtime().fail("cudaMemcpyAsync", 1, cudaErrorIllegalAddress, true);
  ConversionOptions options = with(budget_of(Budget::Kind::rate, 8));
  options.resume = Resume::off;
  options.output = "out.nvdb";
  test::CrashFileSystem files;
  EXPECT_EQ(message_of_error(ErrorKind::io, [&] { convert_volume(*source, options, {}, files); }),
            "copying a box from the device: cudaErrorIllegalAddress, pretended");
  EXPECT_TRUE(files.names().empty());
  runtime().reset();
}

}  // namespace
}  // namespace weir::fake_coder_test
