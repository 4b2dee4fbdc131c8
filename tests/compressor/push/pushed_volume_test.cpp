// A pushed volume ends with the same bytes as a conversion of that volume, whatever the volume, the order of its slabs,
// and the threads that push them.
#include "compressor/push/pushed_volume.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "format/base/error.h"
#include "ingest/values/array_source.h"
#include "tests/compressor/support/hard_cases.h"
#include "tests/compressor/support/push_calls.h"
#include "tests/compressor/support/pushed.h"
#include "tests/support/temporary_directory.h"

namespace weir::pushed_volume_test {
namespace {

using test::Converted;
using test::expect_same;
using test::MemoryVolume;
using test::push;
using test::shuffled_slabs;
using test::Slab;
using test::slabs_in_order;

template <typename T>
std::span<const std::byte> bytes_of(const std::vector<T>& values) {
  return std::as_bytes(std::span(values));
}

class PushedHardCase : public testing::TestWithParam<test::HardCase> {};

TEST_P(PushedHardCase, PushedFileEqualsTheConvertedFile) {
  MemoryVolume volume = GetParam().make();
  const std::int64_t planes = volume.info().extent.z;
  std::uint32_t seed = 0;
  for (const NonFinitePolicy policy : test::policies_of(volume)) {
    for (const Encoding encoding : {Encoding::float32, Encoding::automatic, Encoding::packed}) {
      for (const Budget::Kind kind : {Budget::Kind::automatic, Budget::Kind::lossless}) {
        ConversionOptions options;
        options.non_finite = policy;
        options.encoding = encoding;
        options.budget.kind = kind;
        const Converted expected = test::convert(volume, options);
        const auto values = std::as_bytes(volume.values());
        expect_same(push(volume.info(), values, options, shuffled_slabs(planes, 1 + seed % 20, seed)), expected);
        ++seed;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Volumes, PushedHardCase, testing::ValuesIn(test::hard_cases()),
                         [](const auto& parameter) { return parameter.param.name; });

// Returns waves, empty space, and one voxel of each extreme value.
template <typename T>
std::vector<T> waves(const Index3& extent) {
  std::vector<T> values(static_cast<std::size_t>(volume(extent)));
  for_each_index({{}, extent}, [&](const Index3& i) {
    const double wave =
        60 + 50 * std::sin(static_cast<double>(i.x * i.x + i.y) / 9) * std::cos(static_cast<double>(i.z));
    values[static_cast<std::size_t>(linear_index(i, extent))] = i.x < 40 ? T{3} : static_cast<T>(wave);
  });
  values.front() = std::numeric_limits<T>::max();
  values.back() = std::numeric_limits<T>::lowest();
  return values;
}

template <typename T>
void expect_typed(ScalarType type, const Index3& extent) {
  SCOPED_TRACE(std::string(scalar_name(type)));
  const std::vector<T> values = waves<T>(extent);
  DenseArray array{.data = values.data(), .type = type, .extent = extent, .stride = packed_stride(extent, type)};
  array.missing = {StoredValue{std::int64_t{3}}};
  const auto source = open_array(array);
  ConversionOptions options;
  options.encoding = Encoding::automatic;
  options.non_finite = NonFinitePolicy::background;
  expect_same(push(source->info(), bytes_of(values), options, shuffled_slabs(extent.z, 5, 3), 3),
              test::convert(*source, options));
}

TEST(PushedVolume, TakesEveryScalarTypeAndCountsWhatFloatLoses) {
  for (const Index3& extent : {Index3{1, 1, 1}, Index3{7, 9, 17}, Index3{129, 40, 33}}) {
    expect_typed<std::uint8_t>(ScalarType::uint8, extent);
    expect_typed<std::int8_t>(ScalarType::int8, extent);
    expect_typed<std::uint16_t>(ScalarType::uint16, extent);
    expect_typed<std::int16_t>(ScalarType::int16, extent);
    expect_typed<std::uint32_t>(ScalarType::uint32, extent);
    expect_typed<std::int32_t>(ScalarType::int32, extent);
    expect_typed<std::uint64_t>(ScalarType::uint64, extent);
    expect_typed<std::int64_t>(ScalarType::int64, extent);
    expect_typed<float>(ScalarType::float32, extent);
    expect_typed<double>(ScalarType::float64, extent);
  }
}

TEST(PushedVolume, MeetsEveryKindOfBudgetAndMetric) {
  const Index3 extent{140, 70, 50};
  const std::vector<float> values = [&] {
    std::vector<float> made(static_cast<std::size_t>(volume(extent)));
    for_each_index({{}, extent}, [&](const Index3& i) {
      const double r =
          std::hypot(static_cast<double>(i.x - 60), static_cast<double>(i.y - 30), static_cast<double>(i.z));
      made[static_cast<std::size_t>(linear_index(i, extent))] =
          r > 45 ? 0.0F : static_cast<float>(std::exp(-r / 20) + 0.01 * std::sin(static_cast<double>(i.x * i.y)));
    });
    return made;
  }();
  const auto source = open_array(
      {.data = values.data(), .extent = extent, .stride = packed_stride(extent, ScalarType::float32), .name = "rho"});
  std::vector<ConversionOptions> all;
  for (const Encoding encoding : {Encoding::float32, Encoding::fpn, Encoding::fp8, Encoding::automatic}) {
    for (const Budget::Kind kind : {Budget::Kind::rate, Budget::Kind::psnr, Budget::Kind::max_error}) {
      ConversionOptions options;
      options.encoding = encoding;
      options.budget.kind = kind;
      options.budget.rate = 5;
      options.budget.target = kind == Budget::Kind::psnr ? 60 : 0.01;
      all.push_back(options);
    }
  }
  for (const Metric metric : {Metric::farthest, Metric::closest, Metric::median}) {
    ConversionOptions options;
    options.metric = metric;
    options.fill = FillMode::background;
    options.brick = 16;
    options.paper_background = true;
    all.push_back(options);
  }
  ConversionOptions seen;
  Scene scene;
  scene.volume.range = {0, 1};
  scene.volume.opacity = {{0, 0}, {0.3, 0}, {1, 1}};
  scene.volume.region = Box{{10, 0, 0}, {90, 60, 30}};
  seen.scene = SceneFile{scene, "s.toml"};
  seen.encoding = Encoding::automatic;
  all.push_back(seen);
  std::uint32_t seed = 0;
  for (const ConversionOptions& options : all) {
    SCOPED_TRACE(seed);
    expect_same(push(source->info(), bytes_of(values), options, shuffled_slabs(extent.z, 12, ++seed), 2),
                test::convert(*source, options));
  }
}

TEST(PushedVolume, TakesAxesInAnyOrder) {
  const Index3 extent{31, 20, 45};
  const std::vector<double> values = waves<double>(extent);
  std::vector<double> z_fastest(values.size());
  for_each_index({{}, extent}, [&](const Index3& i) {
    z_fastest[static_cast<std::size_t>(i.z + extent.z * (i.y + extent.y * i.x))] =
        values[static_cast<std::size_t>(linear_index(i, extent))];
  });
  const auto type = ScalarType::float64;
  const auto source =
      open_array({.data = values.data(), .type = type, .extent = extent, .stride = packed_stride(extent, type)});
  ConversionOptions options;
  options.non_finite = NonFinitePolicy::keep;
  const Converted expected = test::convert(*source, options);

  test::CrashFileSystem files;
  options.output = "out.nvdb";
  PushedVolume pushed(source->info(), options, {}, files);
  for (const auto [z0, nz] : shuffled_slabs(extent.z, 9, 1)) {
    pushed.slab(z0, nz, &z_fastest[static_cast<std::size_t>(z0)], {8 * extent.z * extent.y, 8 * extent.z, 8});
  }
  pushed.end();
  EXPECT_TRUE(files.content("out.nvdb") == expected.file);
}

// There is so little memory that most slices are parked, some of them more than once.
TEST(PushedVolume, ParksWhatDoesNotFitTheMemory) {
  const Index3 extent{600, 150, 24};
  std::mt19937 random(7);
  std::vector<float> values(static_cast<std::size_t>(volume(extent)));
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = i % 600 < 300 ? 0 : static_cast<float>(random() % 1000);
  const auto source =
      open_array({.data = values.data(), .extent = extent, .stride = packed_stride(extent, ScalarType::float32)});
  ConversionOptions options;
  options.threads = 1;
  const Converted expected = test::convert(*source, options);
  options.memory = 1;
  try {
    push(source->info(), bytes_of(values), options, {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    const std::string text = error.what();
    options.memory = (std::stoull(text.substr(text.rfind(' ') + 1)) + 1) << 20U;
  }
  for (const std::size_t threads : {1U, 3U}) {
    options.memory += (threads - 1) * (std::uint64_t{5} << 20U);
    for (const std::int64_t highest : {1, 3, 20}) {
      expect_same(push(source->info(), bytes_of(values), options, shuffled_slabs(extent.z, highest, 1), threads),
                  expected);
    }
  }
}

// No slice can hold a whole row.
TEST(PushedVolume, CutsLongRows) {
  const Index3 extent{9001, 17, 20};
  const std::vector<std::int32_t> values = waves<std::int32_t>(extent);
  const auto source = open_array({.data = values.data(),
                                  .type = ScalarType::int32,
                                  .extent = extent,
                                  .stride = packed_stride(extent, ScalarType::int32)});
  ConversionOptions options;
  options.encoding = Encoding::fpn;
  const Converted expected = test::convert(*source, options);
  for (const std::uint64_t mebibytes : {80U, 800U}) {
    options.memory = mebibytes << 20U;
    expect_same(push(source->info(), bytes_of(values), options, shuffled_slabs(extent.z, 1, 2), 2), expected);
  }
}

class RealPush : public testing::TestWithParam<std::string> {};

TEST_P(RealPush, PushedFileEqualsTheConvertedFile) {
  struct Real {
    Index3 extent;
    ScalarType type;
  };
  const std::string file = GetParam();
  const Real real = file.starts_with("mni")    ? Real{{193, 229, 193}, ScalarType::int16}
                    : file.starts_with("wmag") ? Real{{91, 91, 91}, ScalarType::float32}
                                               : Real{{103, 94, 161}, ScalarType::uint8};
  const auto packed = std::filesystem::path(WEIR_SOURCE_DIR) / "../shared/data" / (file + ".xz");
  if (!std::filesystem::exists(packed)) GTEST_SKIP() << "skipped: no " << packed;
  const TemporaryDirectory directory;
  const std::string path = directory / file;
  ASSERT_EQ(std::system(("xz -dc '" + packed.string() + "' > '" + path + "'").c_str()), 0) << "xz-utils missing?";
  std::ifstream stream(path, std::ios::binary);
  const std::vector<char> values{std::istreambuf_iterator<char>(stream), {}};
  const auto source = open_array({.data = values.data(),
                                  .type = real.type,
                                  .extent = real.extent,
                                  .stride = packed_stride(real.extent, real.type)});
  ConversionOptions options;
  options.encoding = Encoding::automatic;
  const Converted expected = test::convert(*source, options);
  expect_same(push(source->info(), bytes_of(values), options, slabs_in_order(real.extent.z, 1)), expected);
  expect_same(push(source->info(), bytes_of(values), options, shuffled_slabs(real.extent.z, 30, 1), 4), expected);
}

INSTANTIATE_TEST_SUITE_P(Manifest, RealPush,
                         testing::Values("tooth_103x94x161_uint8.raw", "mni152_2009_193x229x193_int16.raw",
                                         "wmag_91x91x91_float32.raw"),
                         [](const auto& file) { return file.param.substr(0, file.param.find('_')); });

class PushMisuse : public test::PushCalls {};

TEST_F(PushMisuse, InvalidCallsAreRefusedInOneLineAndChangeNothing) {
  PushedVolume pushed(info_, options_, {}, files_);
  const auto slab = [&](std::int64_t z0, std::int64_t nz, const void* data) {
    return message(ErrorKind::usage, [&] { pushed.slab(z0, nz, data); });
  };
  const auto end = [&] { return message(ErrorKind::usage, [&] { pushed.end(); }); };
  EXPECT_EQ(slab(0, 1, nullptr), "density: the slab's data is a null pointer");
  for (const auto& [z0, nz] : {Slab{-1, 1}, {0, 0}, {0, -3}, {20, 1}, {19, 2}, {1, std::int64_t{1} << 62}}) {
    EXPECT_EQ(slab(z0, nz, values_.data()), "density: a slab of " + std::to_string(nz) +
                                                (nz == 1 ? " plane" : " planes") + " from " + std::to_string(z0) +
                                                " on is not in the volume, whose planes are 0 to 19");
  }
  EXPECT_EQ(end(), "density: planes 0 to 19 of 20 never came; give the rest first");
  EXPECT_EQ(slab(4, 3, values_.data()), "no error");
  EXPECT_EQ(slab(10, 1, values_.data()), "no error");
  EXPECT_EQ(slab(3, 12, values_.data()),
            "density: a slab of 12 planes from 3 on holds planes 4 to 6, given before; give each plane once");
  EXPECT_EQ(slab(10, 1, values_.data()),
            "density: a slab of 1 plane from 10 on holds plane 10, given before; give each plane once");
  EXPECT_EQ(slab(18, 1, values_.data()), "no error");
  EXPECT_EQ(end(), "density: planes 0 to 3, 7 to 9, 11 to 17 and 1 more of 20 never came; give the rest first");
  EXPECT_EQ(files_.names(), (std::vector<std::string>{"out.nvdb.partial"}));
  for (const auto& [z0, nz] : {Slab{0, 4}, {7, 3}, {11, 7}, {19, 1}}) {
    EXPECT_EQ(slab(z0, nz, values_.data()), "no error");
  }
  EXPECT_EQ(end(), "no error");
  EXPECT_EQ(files_.names(), (std::vector<std::string>{"out.nvdb", "out.nvdb.json"}));
  EXPECT_EQ(end(), "density: the volume has ended; begin another one");
  EXPECT_EQ(slab(0, 1, values_.data()), "density: the volume has ended; begin another one");
}

TEST_F(PushMisuse, EndsOnceAndNotBeforeEverySlabIsTaken) {
  info_.extent = {512, 512, 64};
  PushedVolume pushed(info_, options_, {}, files_);
  const float everywhere = 2.5F;
  std::jthread simulation([&] { pushed.slab(0, 64, &everywhere, {0, 0, 0}); });
  const std::string early = "density: planes 0 to 63 of 64 never came; give the rest first";
  std::string answer = early;
  while (answer == early) answer = message(ErrorKind::usage, [&] { pushed.end(); });
  EXPECT_EQ(answer, "density: 1 slab is still being taken; end once every call has returned");
  simulation.join();
  std::atomic<int> ends{0};
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 3; ++t) {
      threads.emplace_back([&] {
        const std::string one = message(ErrorKind::usage, [&] { pushed.end(); });
        if (one == "no error") {
          ++ends;
        } else {
          EXPECT_EQ(one, "density: the volume has ended; begin another one");
        }
      });
    }
  }
  EXPECT_EQ(ends, 1);
  EXPECT_EQ(files_.names(), (std::vector<std::string>{"out.nvdb", "out.nvdb.json"}));
}

TEST_F(PushMisuse, LeavesNothingWithoutAnEnd) {
  {
    PushedVolume pushed(info_, options_, {}, files_);
    pushed.slab(0, 16, values_.data());
  }
  EXPECT_EQ(files_.names(), std::vector<std::string>{});
}

TEST_F(PushMisuse, LeavesNothingWhereTheEndFails) {
  options_.budget.kind = Budget::Kind::size;
  options_.budget.bytes = 1;
  PushedVolume pushed(info_, options_, {}, files_);
  pushed.slab(0, 20, values_.data());
  const std::string first = message(ErrorKind::budget, [&] { pushed.end(); });
  EXPECT_TRUE(first.starts_with("out.nvdb: 1 bytes asked, the smallest tree for this volume takes ")) << first;
  EXPECT_EQ(files_.names(), std::vector<std::string>{});
  EXPECT_EQ(message(ErrorKind::budget, [&] { pushed.end(); }), first);
  EXPECT_EQ(message(ErrorKind::budget, [&] { pushed.slab(0, 1, values_.data()); }), first);
}

TEST_F(PushMisuse, RefusesNonFiniteValuesAsAConversionDoes) {
  values_[7 * 45 + 3] = std::numeric_limits<float>::quiet_NaN();
  PushedVolume pushed(info_, options_, {}, files_);
  pushed.slab(0, 20, values_.data());
  EXPECT_EQ(message(ErrorKind::input, [&] { pushed.end(); }),
            "density: 1 voxel is NaN or infinite, the first (nan) at 3,0,7; choose --nonfinite background or "
            "--nonfinite keep");
}

TEST_F(PushMisuse, RefusesAnOutputThatIsThere) {
  files_.create("out.nvdb");
  EXPECT_EQ(message(ErrorKind::usage, [&] { PushedVolume(info_, options_, {}, files_); }),
            "out.nvdb: exists; choose another output or pass --overwrite");
}

TEST_F(PushMisuse, CancelledPushStaysInterrupted) {
  std::atomic<bool> cancel{false};
  ConversionControl control;
  control.cancel = &cancel;
  PushedVolume pushed(info_, options_, control, files_);
  pushed.slab(0, 10, values_.data());
  cancel = true;
  EXPECT_EQ(message(ErrorKind::interrupted, [&] { pushed.slab(10, 10, values_.data()); }),
            "interrupted; nothing was written");
  EXPECT_EQ(files_.names(), std::vector<std::string>{});
  cancel = false;
  EXPECT_EQ(message(ErrorKind::interrupted, [&] { pushed.end(); }), "interrupted; nothing was written");
}

}  // namespace
}  // namespace weir::pushed_volume_test
