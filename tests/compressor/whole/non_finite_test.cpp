// Every NaN and infinity is refused unless the options say otherwise. Values that only float32 makes infinite are told
// apart from values that are infinite in the source.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "compressor/conversion.h"
#include "format/base/error.h"
#include "ingest/raw/raw_source.h"
#include "tests/compressor/support/converted.h"
#include "tests/compressor/support/two_materials.h"
#include "tests/support/message_of_error.h"
#include "tests/support/temporary_directory.h"

namespace weir::non_finite_test {
namespace {

using test::MemoryVolume;

std::string refusal(VolumeSource& volume) {
  return message_of_error(ErrorKind::input, [&] { test::convert(volume, {}); });
}

TEST(NonFinite, NaNOfTheBitsThatMarkMissingData_IsRefused) {
  MemoryVolume volume({{0, 0, 0}, {16, 16, 16}}, [](const Index3& i) {
    return i == Index3{3, 4, 5} ? missing_value() : 1.0F;
  });
  EXPECT_EQ(refusal(volume),
            "memory: 1 voxel is NaN or infinite, the first (nan) at 3,4,5; choose --nonfinite background or "
            "--nonfinite keep");
}

TEST(NonFinite, EveryPatternIsCounted_AndKeptBitForBit) {
  // Steps by a prime through all 2^24 bit patterns with an exponent of ones.
  const auto pattern = [](std::uint32_t n) {
    const std::uint32_t at = n * 2053 % (1U << 24U);
    return std::bit_cast<float>((at & 0x7FFFFFU) | 0x7F800000U | (at >> 23U) << 31U);
  };
  std::vector<float> values(20 * 20 * 20);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = pattern(static_cast<std::uint32_t>(i));
  values[17] = missing_value();
  MemoryVolume volume({{0, 0, 0}, {20, 20, 20}}, values);
  const std::string message = refusal(volume);
  EXPECT_EQ(message.substr(0, message.find(',')), "memory: 8000 voxels are NaN or infinite");
  ConversionOptions options;
  options.non_finite = NonFinitePolicy::keep;
  options.budget.kind = Budget::Kind::lossless;
  const test::Converted kept = test::convert(volume, options);
  EXPECT_EQ(kept.sidecar.nonfinite.count, 8000U);
  EXPECT_EQ(kept.sidecar.missing.count, 0U);
  for (std::int64_t n = 0; n < 8000; ++n) {
    EXPECT_EQ(test::bits_of(kept.grid().value(index_at(n, {20, 20, 20}))),
              test::bits_of(values[static_cast<std::size_t>(n)]));
  }
}

// A block with one value and with voxels without a value becomes a tile of that value. No finite value is lost.
TEST(NonFinite, ATileThatKeepsItsFiniteValues_IsLosslessOverValidVoxels) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  MemoryVolume volume({{0, 0, 0}, {24, 8, 8}}, [](const Index3& i) {
    if (i.x < 8 || i.x >= 16) return static_cast<float>(i.x + 64 * i.y + 8 * i.z);
    return i.x < 12 && i.y == 0 && i.z == 0 ? 7.0F : kNaN;
  });
  for (const Encoding encoding : {Encoding::float32, Encoding::automatic, Encoding::packed}) {
    SCOPED_TRACE(encoding_name(encoding));
    ConversionOptions options;
    options.encoding = encoding;
    options.non_finite = NonFinitePolicy::background;
    options.background = 100;
    options.budget.kind = Budget::Kind::max_error;
    options.budget.target = 0;
    const test::Converted converted = test::convert(volume, options);
    const Sidecar& sidecar = converted.sidecar;
    EXPECT_EQ(sidecar.error.max_abs, 0);
    EXPECT_TRUE(sidecar.error.lossless);
    EXPECT_FALSE(sidecar.error.psnr_db);
    // With a lossless budget, NaN also reads as the background.
    options.budget.kind = Budget::Kind::lossless;
    const test::Converted lossless = test::convert(volume, options);
    EXPECT_TRUE(lossless.sidecar.error.lossless);
    if (encoding != Encoding::packed) {
      EXPECT_EQ(lossless.grid().value({15, 7, 7}), 100.0F);
      EXPECT_EQ(lossless.grid().value({9, 0, 0}), 7.0F);
    }
  }
}

class Float64 : public testing::Test {
 protected:
  std::string refusal_of(const std::vector<double>& values) {
    const std::string path = directory_ / "v.raw";
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(std::span(values).size_bytes()));
    SourceOptions source;
    source.extent = {8, 8, 8};
    source.type = ScalarType::float64;
    const std::string message = refusal(*open_raw(path, source));
    return message.substr(path.size());
  }

  TemporaryDirectory directory_;
};

TEST(NonFinite, BlocksThatKeepTheirFiniteValues_AreLosslessOverValidVoxels) {
  MemoryVolume volume = test::two_materials(16);
  ConversionOptions options;
  options.non_finite = NonFinitePolicy::background;
  options.background = 0.3F;
  for (const Encoding encoding : {Encoding::fpn, Encoding::packed}) {
    SCOPED_TRACE(encoding_name(encoding));
    options.encoding = encoding;
    options.budget.kind = Budget::Kind::psnr;
    int without_error = 0;
    for (const double target : {30, 40, 50, 70, 90, 110, 130}) {
      options.budget.target = target;
      const Sidecar::CertifiedError error = test::convert(volume, options).sidecar.error;
      EXPECT_EQ(error.lossless, error.max_abs == 0) << target;
      without_error += error.lossless ? 1 : 0;
    }
    EXPECT_GT(without_error, 0);
  }
  options.encoding = Encoding::automatic;
  options.budget.kind = Budget::Kind::lossless;
  const test::Converted exact = test::convert(volume, options);
  for (std::int64_t n = 0; n < volume.info().domain().voxels(); ++n) {
    const Index3 i = index_at(n, volume.info().extent);
    if (!std::isnan(volume.at(i))) continue;
    ASSERT_EQ(exact.grid().value(i), 0.3F);
  }
}

TEST_F(Float64, FiniteBeyondFloat32_IsReportedAsSuch) {
  std::vector<double> values(512, 1.0);
  values[9] = 1e300;
  EXPECT_EQ(refusal_of(values),
            ": 1 voxel is finite but beyond the 3.4e+38 of float32, the first (inf as float32) at 1,1,0; scale the "
            "values, or choose --nonfinite background or --nonfinite keep");
  values[3] = -4e38;
  values[500] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal_of(values),
            ": 1 voxel is NaN or infinite and 2 voxels are finite but beyond the 3.4e+38 of float32, the first (-inf "
            "as float32) at 3,0,0; scale the values, or choose --nonfinite background or --nonfinite keep");
  values[3] = values[9] = 3.4e38;
  EXPECT_EQ(refusal_of(values),
            ": 1 voxel is NaN or infinite, the first (nan) at 4,6,7; choose --nonfinite background or --nonfinite "
            "keep");
}

}  // namespace
}  // namespace weir::non_finite_test
