// Decoded values stay inside the volume's own range, and the sidecar counts the zeros that decode to another value.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "format/nanovdb/read_box.h"
#include "tests/compressor/support/converted.h"
#include "tests/compressor/support/memory_volume.h"

namespace weir::value_range_test {
namespace {

using test::MemoryVolume;

constexpr Box kDomain{{3, 5, 0}, {76, 66, 53}};

float wave(const Index3& i) {
  return std::sin(static_cast<float>(i.x) * 0.21F) + std::sin(static_cast<float>(i.y) * 0.17F + 1) +
         std::cos(static_cast<float>(i.z) * 0.13F);
}
// Half of the volume is empty; the rest has values from 0 up.
float density(const Index3& i) { return std::max(wave(i), 0.0F); }
// All values are small and above 0.
float concentration(const Index3& i) { return 1e-6F * std::exp(4 * wave(i)); }
float depth(const Index3& i) { return -density(i); }
// concentration() with noise in every voxel.
float noisy(const Index3& i) {
  const auto hash = static_cast<std::uint32_t>(i.x * 73856093 ^ i.y * 19349663 ^ i.z * 83492791) * 2654435761U;
  return concentration(i) * (1 + static_cast<float>(hash >> 8U) * 0x1p-24F);
}
// Zeros between values of both signs.
float signed_field(const Index3& i) { return (i.x + i.y + i.z) % 5 == 0 ? 0.0F : wave(i); }

struct Case {
  const char* name;
  float (*value)(const Index3&);
};

class ValueRange : public testing::TestWithParam<Case> {};

TEST_P(ValueRange, DecodedValuesStayInIt_AndZerosThatAreLostAreCounted) {
  MemoryVolume volume(kDomain, GetParam().value);
  const auto [least, most] = std::ranges::minmax(volume.values());
  const auto zeros = static_cast<std::uint64_t>(std::ranges::count(volume.values(), 0.0F));
  for (const Encoding encoding : {Encoding::fpn, Encoding::automatic, Encoding::fp4, Encoding::fp8, Encoding::fp16,
                                  Encoding::packed, Encoding::float32}) {
    const double range = static_cast<double>(most) - static_cast<double>(least);
    for (const Budget& budget : {Budget{Budget::Kind::rate, 1.1, 0, 0}, Budget{Budget::Kind::rate, 1.6, 0, 0},
                                 Budget{Budget::Kind::rate, 2.4, 0, 0}, Budget{Budget::Kind::psnr, 8, 0, 140},
                                 Budget{Budget::Kind::max_error, 8, 0, 0.1 * range}}) {
      if (budget.by_error() && encoding != Encoding::automatic && encoding != Encoding::packed) continue;
      ConversionOptions options;
      options.encoding = encoding;
      options.budget = budget;
      const test::Converted converted = test::convert(volume, options);
      std::vector<float> decoded(volume.values().size());
      read_box(converted.grid(), kDomain, decoded);
      const std::string what =
          std::string(encoding_name(encoding)) + ", file of " + std::to_string(converted.file.size()) + " bytes";
      EXPECT_GE(*std::ranges::min_element(decoded), least) << what;
      EXPECT_LE(*std::ranges::max_element(decoded), most) << what;
      std::uint64_t lost = 0;
      for (std::size_t i = 0; i < decoded.size(); ++i) lost += volume.values()[i] == 0 && decoded[i] != 0 ? 1 : 0;
      ASSERT_TRUE(converted.sidecar.zeros);
      EXPECT_EQ(converted.sidecar.zeros->count, zeros) << what;
      EXPECT_EQ(converted.sidecar.zeros->lost, lost) << what;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Volumes, ValueRange,
                         testing::Values(Case{"density", density}, Case{"concentration", concentration},
                                         Case{"noisy", noisy}, Case{"depth", depth}, Case{"signed", signed_field}),
                         [](const auto& param) { return std::string(param.param.name); });

}  // namespace
}  // namespace weir::value_range_test
