#include "ingest/values/array_source.h"

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <thread>

#include "tests/ingest/support/scratch.h"

namespace weir::array_source_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

template <typename T>
DenseArray packed(const std::vector<T>& values, const Index3& extent, ScalarType type) {
  return {.data = values.data(), .type = type, .extent = extent, .stride = packed_stride(extent, type)};
}

std::vector<float> read(VolumeSource& source, const Box& box) {
  std::vector<float> values(static_cast<std::size_t>(box.voxels()), -1.0F);
  source.read(box, values);
  return values;
}

template <typename T>
void expect_type(ScalarType type) {
  const Index3 extent{7, 5, 9};
  std::vector<T> values(7 * 5 * 9);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<T>(i % 126);
  const auto source = open_array(packed(values, extent, type));
  EXPECT_EQ(source->info().type, type);
  EXPECT_EQ(source->access().bytes_per_voxel, sizeof(T));
  EXPECT_EQ(source->info().file_bytes, values.size() * sizeof(T));
  const auto all = read(*source, source->info().domain());
  for (std::size_t i = 0; i < all.size(); ++i) ASSERT_EQ(all[i], static_cast<float>(i % 126)) << scalar_name(type);
  EXPECT_EQ(source->bytes_read(), values.size() * sizeof(T));
}

TEST(ArraySource, AllTypes) {
  expect_type<std::uint8_t>(ScalarType::uint8);
  expect_type<std::int8_t>(ScalarType::int8);
  expect_type<std::uint16_t>(ScalarType::uint16);
  expect_type<std::int16_t>(ScalarType::int16);
  expect_type<std::uint32_t>(ScalarType::uint32);
  expect_type<std::int32_t>(ScalarType::int32);
  expect_type<std::uint64_t>(ScalarType::uint64);
  expect_type<std::int64_t>(ScalarType::int64);
  expect_type<float>(ScalarType::float32);
  expect_type<double>(ScalarType::float64);
  const std::vector<std::uint16_t> halves{0x3C00, 0xC000};  // 1 and -2
  EXPECT_EQ(read(*open_array(packed(halves, {2, 1, 1}, ScalarType::float16)), {{0, 0, 0}, {2, 1, 1}}),
            (std::vector<float>{1, -2}));
}

TEST(ArraySource, InfoSaysWhatTheArrayIs) {
  const std::vector<float> values(24);
  DenseArray array = packed(values, {4, 3, 2}, ScalarType::float32);
  array.name = "density";
  array.spacing = {0.5, 1, 2};
  array.origin = {-1, 0, 1};
  const auto source = open_array(array);
  const SourceInfo& info = source->info();
  EXPECT_EQ(info.path, "memory");
  EXPECT_EQ(info.format, "memory");
  EXPECT_EQ(info.dataset, "density");
  EXPECT_EQ(info.extent, (Index3{4, 3, 2}));
  EXPECT_EQ(info.spacing, array.spacing);
  EXPECT_EQ(info.origin, array.origin);
  EXPECT_GT(info.mtime_ns, 0);
  EXPECT_TRUE(source->in_memory());
  EXPECT_EQ(source->working_bytes(), 0U);
}

/// An array of `extent` in a block of bytes. In memory its axes come in `order` (fastest first), each axis is padded,
/// and axes that are `flipped` run backwards. No value is aligned.
struct Strided {
  std::vector<std::byte> bytes;
  DenseArray array;

  Strided(const Index3& extent, std::array<std::size_t, 3> order, std::array<bool, 3> flipped, std::int64_t element,
          std::int64_t pad) {
    const std::array<std::int64_t, 3> extents{extent.x, extent.y, extent.z};
    std::int64_t step = element;
    std::int64_t first = 1;
    for (const std::size_t axis : order) {
      array.stride[axis] = flipped[axis] ? -step : step;
      if (flipped[axis]) first += step * (extents[axis] - 1);
      step *= extents[axis] + pad;
    }
    bytes.assign(static_cast<std::size_t>(1 + step), std::byte{0xEE});
    array.extent = extent;
    array.type = ScalarType::float32;
    array.data = bytes.data() + first;
    for_each_index({{}, extent}, [&](const Index3& i) {
      const auto value = static_cast<float>(linear_index(i, extent));
      std::memcpy(bytes.data() + first + i.x * array.stride[0] + i.y * array.stride[1] + i.z * array.stride[2], &value,
                  sizeof value);
    });
  }
};

// The array is wider than a tile, and boxes begin and end inside a tile.
TEST(ArraySource, AnyOrderOfAxesAnyBox) {
  const Index3 extent{300, 21, 19};
  const std::array<std::array<std::size_t, 3>, 6> orders{
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  for (const auto& order : orders) {
    for (const std::int64_t pad : {0, 3}) {
      for (const std::int64_t element : {4, 12}) {  // one component, and one of three interleaved
        for (const std::array<bool, 3>& flipped :
             {std::array{false, false, false}, std::array{true, false, true}, std::array{false, true, false}}) {
          const Strided strided(extent, order, flipped, element, pad);
          const auto source = open_array(strided.array);
          for (const Box& box : {Box{{0, 0, 0}, extent}, Box{{0, 0, 5}, {300, 21, 6}}, Box{{0, 3, 2}, {300, 20, 18}},
                                 Box{{255, 15, 15}, {258, 18, 18}}, Box{{299, 20, 18}, extent}}) {
            const auto values = read(*source, box);
            std::size_t i = 0;
            for_each_index(
                box, [&](const Index3& at) { ASSERT_EQ(values[i++], static_cast<float>(linear_index(at, extent))); });
          }
        }
      }
    }
  }
}

// A broadcast array repeats a plane along z with a stride of zero.
TEST(ArraySource, AStrideOfZeroRepeats) {
  const std::vector<float> plane{1, 2, 3, 4};
  DenseArray array = packed(plane, {2, 2, 3}, ScalarType::float32);
  array.stride[2] = 0;
  EXPECT_EQ(read(*open_array(array), {{0, 0, 0}, {2, 2, 3}}), (std::vector<float>{1, 2, 3, 4, 1, 2, 3, 4, 1, 2, 3, 4}));
}

TEST(ArraySource, ManyThreadsReadAtOnce) {
  const Index3 extent{64, 48, 32};
  const Strided strided(extent, {2, 1, 0}, {}, 4, 0);
  const auto source = open_array(strided.array);
  std::vector<std::jthread> threads;
  for (std::int64_t z = 0; z < 32; z += 8) {
    threads.emplace_back([&, z] {
      const auto slab = read(*source, {{0, 0, z}, {64, 48, z + 8}});
      for (std::size_t i = 0; i < slab.size(); ++i) {
        if (slab[i] != static_cast<float>(z * 64 * 48) + static_cast<float>(i)) ADD_FAILURE() << z << ' ' << i;
      }
    });
  }
  threads.clear();
  EXPECT_EQ(source->bytes_read(), static_cast<std::uint64_t>(volume(extent)) * 4);
}

// Loss and missing values are those of a raw file of the same values, in any order of axes.
TEST(ArraySource, LossAndMissingAreThoseOfARawFile) {
  const Index3 extent{5, 4, 3};
  std::vector<double> values(60, 1.0);
  values[0] = 0.1;
  values[7] = 1e300;
  values[20] = -9999;
  values[33] = kInfinity;
  std::vector<double> transposed(60);  // z fastest
  for_each_index({{}, extent}, [&](const Index3& i) {
    transposed[static_cast<std::size_t>(i.z + 3 * (i.y + 4 * i.x))] =
        values[static_cast<std::size_t>(linear_index(i, extent))];
  });
  DenseArray fortran = packed(values, extent, ScalarType::float64);
  DenseArray c = packed(transposed, extent, ScalarType::float64);
  c.stride = {8 * 3 * 4, 8 * 3, 8};
  for (DenseArray array : {fortran, c}) {
    array.missing = {-9999.0};
    const auto source = open_array(array);
    std::vector<float> out(60);
    const ConversionLoss loss = source->read(source->info().domain(), out);
    EXPECT_EQ(loss.inexact, 1U);
    EXPECT_EQ(loss.overflow, 1U);
    EXPECT_EQ(loss.max_abs_error, std::abs(static_cast<double>(0.1F) - 0.1));
    EXPECT_EQ(out[0], 0.1F);
    EXPECT_EQ(out[7], std::numeric_limits<float>::infinity());
    EXPECT_TRUE(is_missing(out[20]));
    EXPECT_EQ(out[33], std::numeric_limits<float>::infinity());
  }
}

TEST(ArraySource, RefusesInvalidArrays) {
  const std::vector<float> values(24);
  const DenseArray good = packed(values, {4, 3, 2}, ScalarType::float32);
  const auto refusal = [&](ErrorKind kind, const auto& change) {
    DenseArray array = good;
    change(array);
    return message_of_error(kind, [&] { open_array(array); });
  };
  EXPECT_EQ(refusal(ErrorKind::usage, [](DenseArray& a) { a.data = nullptr; }),
            "memory: the array's data is a null pointer");
  EXPECT_EQ(refusal(ErrorKind::input, [](DenseArray& a) { a.extent.y = 0; }),
            "memory: extent 4x0x2 has 0 voxels along y; each axis must be 1 to 2147483647");
  EXPECT_EQ(refusal(ErrorKind::usage, [](DenseArray& a) { a.stride[1] = INT64_MAX / 2 + 1; }),
            "memory: a stride of 4611686018427387904 bytes along y for 3 voxels leaves the address space; strides are "
            "in bytes");
  EXPECT_EQ(refusal(ErrorKind::usage, [](DenseArray& a) { a.stride[2] = INT64_MIN; }),
            "memory: a stride of -9223372036854775808 bytes along z for 2 voxels leaves the address space; strides are "
            "in bytes");
  EXPECT_EQ(refusal(ErrorKind::usage, [](DenseArray& a) { a.spacing[2] = 0; }),
            "memory: the spacing has 0; each must be finite and above 0");
  EXPECT_EQ(refusal(ErrorKind::usage, [](DenseArray& a) { a.spacing[0] = kInfinity; }),
            "memory: the spacing has inf; each must be finite and above 0");
  EXPECT_EQ(refusal(ErrorKind::usage, [](DenseArray& a) { a.origin[0] = kNoNumber; }),
            "memory: the origin has nan; each must be finite");
  EXPECT_EQ(refusal(ErrorKind::usage, [](DenseArray& a) { a.origin[1] = -1e300; }),
            "memory: the origin has -1e+300; each must be within -1e+37 and 1e+37");
  EXPECT_EQ(refusal(ErrorKind::usage,
                    [](DenseArray& a) {
                      a.type = ScalarType::uint8;
                      a.missing = {StoredValue{std::int64_t{-1}}};
                    }),
            "memory: the missing value is -1, and no uint8 is; give a value of that type");
}

TEST(ArraySource, BoxesOutsideTheVolumeAreAnInternalError) {
  const std::vector<float> values(24);
  const auto source = open_array(packed(values, {4, 3, 2}, ScalarType::float32));
  std::vector<float> one(1);
  EXPECT_EQ(message_of_error(ErrorKind::internal,
                             [&] {
                               source->read({{4, 0, 0}, {5, 1, 1}}, one);
                             }),
            "memory: read of box 4:5,0:1,0:1 into 1 values does not fit 0:4,0:3,0:2");
  message_of_error(ErrorKind::internal, [&] { source->read({{0, 0, 0}, {2, 1, 1}}, one); });
  message_of_error(ErrorKind::internal, [&] { source->read({{0, 0, 0}, {0, 1, 1}}, one); });
}

}  // namespace
}  // namespace weir::array_source_test
