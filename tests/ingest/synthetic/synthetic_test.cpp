#include "ingest/synthetic/synthetic.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <xxhash.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "tests/support/message_of_error.h"

namespace weir::synthetic_test {
namespace {

std::vector<float> read_box(VolumeSource& source, const Box& box) {
  std::vector<float> values(static_cast<std::size_t>(box.voxels()));
  const ConversionLoss loss = source.read(box, values);
  EXPECT_EQ(loss.inexact, 0U);
  EXPECT_EQ(loss.overflow, 0U);
  return values;
}

std::vector<float> make_volume(std::string_view kind, const Index3& extent, std::uint64_t seed = 1) {
  const auto source = open_synthetic(kind, {extent, seed});
  return read_box(*source, source->info().domain());
}

std::string digest(const std::vector<float>& values) {
  return hex(XXH3_64bits(values.data(), values.size() * sizeof(float)));
}

std::string message_of(const std::function<void()>& call) {
  return message_of_error(ErrorKind::usage, [&] { call(); });
}

class EveryKind : public testing::TestWithParam<std::string> {};

// Golden digests of 70 x 45 x 37 voxels at seed 7. The values are a promise and are the same with every compiler.
TEST_P(EveryKind, HasItsGoldenDigest) {
  const std::map<std::string, std::string> golden{
      {"cloud", "65c38ba15a7930a7"},         {"turbulence", "653c8a62b3c6742d"},
      {"noise", "563a4402f985488d"},         {"sphere", "c01789e0841c9a39"},
      {"gradient", "1a8bfc10f523b899"},      {"constant", "3d49574e27c0c2cf"},
      {"zero", "63b6fde337958635"},          {"nan", "6a5b1ffae1f9a6f8"},
      {"some-nan", "28c77ec3957692db"},      {"denormal", "624ab4a6d3285a0c"},
      {"negative-zero", "1f55da4d6a93bfad"}, {"huge", "9856ef0f25ea08ec"},
      {"tiny", "907d45f0d5e219b4"},          {"offset", "ea48d306e89774f9"},
      {"big-integer", "6ebfb93ef4dc71a9"},   {"ties", "d61cfff3c5e30f09"},
      {"background", "97b3c073a0d5e8bf"},    {"signed", "31bbec7b5edfe78"},
      {"hot-voxel", "5d8fa2c03a4ecb07"},     {"plateau", "63534abbd84a2191"},
      {"checkerboard", "52d814e12594eb82"},  {"nearly-constant", "da4c6260e57f34d"},
  };
  EXPECT_EQ(digest(make_volume(GetParam(), {70, 45, 37}, 7)), golden.at(GetParam())) << GetParam();
}

TEST_P(EveryKind, DoesNotDependOnTheBox) {
  const auto source = open_synthetic(GetParam(), {{75, 50, 41}, 3});
  const std::vector<float> whole = read_box(*source, source->info().domain());
  for (const Box& box : {Box{{0, 0, 0}, {75, 50, 8}}, Box{{31, 17, 5}, {66, 49, 40}}, Box{{0, 49, 40}, {75, 50, 41}},
                         Box{{74, 0, 0}, {75, 50, 41}}, Box{{33, 34, 35}, {34, 35, 36}}}) {
    const std::vector<float> part = read_box(*source, box);
    for (std::int64_t i = 0; i < box.voxels(); ++i) {
      const auto at = static_cast<std::size_t>(linear_index(box.lo + index_at(i, box.extent()), {75, 50, 41}));
      ASSERT_EQ(std::memcmp(&part[static_cast<std::size_t>(i)], &whole[at], sizeof(float)), 0)
          << GetParam() << " " << i;
    }
  }
}

TEST_P(EveryKind, DoesNotDependOnThreadsOrOrder) {
  const Index3 extent{96, 40, 64};
  std::string one_thread;
  {
    const tbb::global_control single(tbb::global_control::max_allowed_parallelism, 1);
    one_thread = digest(make_volume(GetParam(), extent));
  }
  const auto source = open_synthetic(GetParam(), {extent, 1});
  std::vector<float> values(static_cast<std::size_t>(volume(extent)));
  tbb::parallel_for(0, 8, [&](int slab) {  // several threads inside read() at once
    const std::int64_t z = 8 * (7 - slab);
    const Box box{{0, 0, z}, {96, 40, z + 8}};
    source->read(box, std::span(values).subspan(static_cast<std::size_t>(z * 96 * 40), 96 * 40 * 8));
  });
  EXPECT_EQ(digest(values), one_thread);
  EXPECT_EQ(source->bytes_read(), values.size() * 4);
}

TEST_P(EveryKind, HoldsForOneVoxelAndForLines) {
  EXPECT_EQ(make_volume(GetParam(), {1, 1, 1}).size(), 1U);
  EXPECT_EQ(make_volume(GetParam(), {1, 1, 300}).size(), 300U);
  EXPECT_EQ(make_volume(GetParam(), {300, 1, 1}).size(), 300U);
}

TEST_P(EveryKind, StaysInItsNominalRange) {
  const SyntheticKind& kind = find_synthetic_kind(GetParam());
  for (const float value : make_volume(GetParam(), {64, 64, 64}, 5)) {
    if (std::isfinite(value)) {
      ASSERT_GE(value, kind.min);
      ASSERT_LE(value, kind.max);
    } else {
      ASSERT_EQ(kind.scaling, IntegerScaling::none);
    }
  }
}

std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  for (const SyntheticKind& kind : synthetic_kinds()) names.emplace_back(kind.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Synthetic, EveryKind, testing::ValuesIn(kind_names()), [](const auto& instance) {
  std::string name = instance.param;
  for (char& c : name) c = c == '-' ? '_' : c;
  return name;
});

TEST(Synthetic, SeedChangesTheRandomKindsOnly) {
  std::string unchanged;
  for (const SyntheticKind& kind : synthetic_kinds()) {
    if (digest(make_volume(kind.name, {40, 40, 40}, 1)) == digest(make_volume(kind.name, {40, 40, 40}, 2))) {
      unchanged += cat(kind.name, ' ');
    }
  }
  EXPECT_EQ(unchanged, "sphere gradient constant zero nan some-nan huge ties plateau checkerboard ");
}

TEST(Synthetic, InfoDescribesTheVolume) {
  const auto source = open_synthetic("cloud", {{10, 20, 30}, 1});
  EXPECT_EQ(source->info().path, "synthetic:cloud");
  EXPECT_EQ(source->info().format, "synthetic");
  EXPECT_EQ(source->info().domain(), (Box{{0, 0, 0}, {10, 20, 30}}));
  EXPECT_EQ(source->info().type, ScalarType::float32);
  EXPECT_EQ(source->access().chunk, (Index3{0, 0, 0}));
  EXPECT_EQ(source->bytes_read(), 0U);
}

TEST(Synthetic, UnknownKindListsTheKnown) {
  const std::string message = message_of([] { open_synthetic("fog", {{8, 8, 8}, 1}); });
  EXPECT_TRUE(message.starts_with("kind of volume is \"fog\", it must be one of cloud, turbulence, noi")) << message;
}

TEST(Synthetic, ExtentOutOfRange) {
  const std::string remedy = " is out of range; every axis must be 1 to 2147483647 and the volume below 2^60 voxels";
  EXPECT_EQ(message_of([] { open_synthetic("zero", {{8, 0, 8}, 1}); }), "extent 8,0,8" + remedy);
  EXPECT_EQ(message_of([] { open_synthetic("zero", {{-1, 8, 8}, 1}); }), "extent -1,8,8" + remedy);
  EXPECT_EQ(message_of([] { open_synthetic("zero", {{2147483648, 1, 1}, 1}); }), "extent 2147483648,1,1" + remedy);
  EXPECT_EQ(message_of([] {
              open_synthetic("zero", {{2147483647, 2147483647, 8}, 1});
            }),
            "extent 2147483647,2147483647,8" + remedy);
}

}  // namespace
}  // namespace weir::synthetic_test
