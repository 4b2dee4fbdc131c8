// Packed files: exact sizes, certificates of the values that weir's reader decodes, kept budgets, the same bytes
// whatever the threads, the memory and the access shape, and what stock readers see.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "format/nanovdb/read_box.h"
#include "ingest/synthetic/synthetic.h"
#include "tests/compressor/support/converted.h"
#include "tests/compressor/support/hard_cases.h"
#include "tests/compressor/support/memory_volume.h"
#include "tests/compressor/support/packed_files.h"
#include "tests/compressor/support/random_volumes.h"
#include "tests/support/message_of_error.h"
#include "tests/support/sanitized.h"

namespace weir::packed_conversion_test {
namespace {

using test::Converted;
using test::decoded;
using test::expect_certificate;
using test::kPackedDomain;
using test::MemoryVolume;
using test::packed;
using test::smooth;

class PackedSize : public testing::TestWithParam<Preview> {};

TEST_P(PackedSize, EveryAskedSizeIsWrittenAndMoreBytesNeverLoseMore) {
  MemoryVolume volume(kPackedDomain, smooth);
  ConversionOptions options = packed(Budget::Kind::size, 0);
  options.preview = GetParam();
  const std::uint64_t least = test::minimum_size(volume, options);
  ConversionOptions whole = packed(Budget::Kind::lossless, 0);
  whole.preview = GetParam();
  const std::uint64_t most = test::convert(volume, whole).file.size();
  double last = 1e300;
  for (std::uint64_t i = 0; i <= 40; ++i) {
    const std::uint64_t bytes = least + (most - least) * i * i / 1600 + i % 7;
    options.budget.bytes = bytes;
    const Converted converted = test::convert(volume, options);
    ASSERT_EQ(converted.file.size(), bytes);
    EXPECT_EQ(converted.sidecar.file.bytes, bytes);
    expect_certificate(volume, converted, options, std::to_string(bytes));
    // Selection uses errors of coefficients rounded to float. They match the errors of values to parts of a thousand.
    EXPECT_LE(converted.sidecar.error.mse, last * 1.001) << bytes;
    last = converted.sidecar.error.mse;
    EXPECT_EQ(converted.grid().index_bbox(), kPackedDomain);
  }
  options.budget.bytes = most + static_cast<std::uint64_t>(kPackedDomain.voxels()) * 8;
  EXPECT_TRUE(test::convert(volume, options).sidecar.error.lossless);
}

INSTANTIATE_TEST_SUITE_P(Previews, PackedSize, testing::Values(Preview::on, Preview::off),
                         [](const auto& p) { return p.param == Preview::on ? "on" : "off"; });

TEST(PackedConversion, BytesDoNotDependOnThreadsMemoryOrAccess) {
  MemoryVolume volume(kPackedDomain, smooth);
  ConversionOptions options = packed(Budget::Kind::rate, 20);
  const Converted first = test::convert(volume, options);
  for (const std::size_t threads : {1U, 2U, 5U}) {
    for (const AccessShape& access :
         {AccessShape{4, {70, 67, 1}, {0, 0, 0}}, AccessShape{4, {16, 16, 16}, {0, 0, 0}}}) {
      volume.set_access(access);
      options.threads = threads;
      options.memory = std::uint64_t{threads == 5 || kSanitized ? 1024U : 160U} << 20U;
      EXPECT_TRUE(test::convert(volume, options).file == first.file) << threads;
    }
  }
}

TEST(PackedConversion, KeepsEveryVoxelWithinTheLargestError) {
  MemoryVolume volume(kPackedDomain, smooth);
  std::uint64_t last = 0;
  for (const double bound : {0.3, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
    const ConversionOptions options = packed(Budget::Kind::max_error, bound);
    const Converted converted = test::convert(volume, options);
    expect_certificate(volume, converted, options, std::to_string(bound));
    EXPECT_LE(converted.sidecar.error.max_abs, bound);
    EXPECT_GE(converted.file.size(), last);
    last = converted.file.size();
  }
}

TEST(PackedConversion, ReachesThePsnrWithLittleMore) {
  MemoryVolume volume(kPackedDomain, smooth);
  for (const double psnr : {30.0, 50.0, 70.0, 90.0}) {
    const ConversionOptions options = packed(Budget::Kind::psnr, psnr);
    const Converted converted = test::convert(volume, options);
    expect_certificate(volume, converted, options, std::to_string(psnr));
    ASSERT_TRUE(converted.sidecar.error.psnr_db.has_value());
    EXPECT_GE(*converted.sidecar.error.psnr_db, psnr);
    EXPECT_LE(*converted.sidecar.error.psnr_db, psnr + 1);
  }
}

// Decoded errors of a sparse cloud are smaller than what the survey counts, because no value falls below zero.
TEST(PackedConversion, ThePsnrOfASparseCloudIsNoLargerThanNeedBe) {
  const auto source = open_synthetic("cloud", {{96, 80, 72}, 1});
  MemoryVolume volume(*source);
  for (const double target : {45.0, 55.0}) {
    const Converted converted = test::convert(volume, packed(Budget::Kind::psnr, target));
    EXPECT_GE(*converted.sidecar.error.psnr_db, target);
    EXPECT_LE(*converted.sidecar.error.psnr_db, target + 0.1);
    EXPECT_EQ(converted.files_made, 2) << target;
  }
}

TEST(PackedConversion, AFileOfDenseTurbulenceReachesItsPsnrAtOnce) {
  const auto source = open_synthetic("turbulence", {{80, 72, 64}, 1});
  MemoryVolume volume(*source);
  for (const double target : {50.0, 60.0, 80.0, 100.0}) {
    EXPECT_EQ(test::convert(volume, packed(Budget::Kind::psnr, target)).files_made, 1) << target;
  }
}

// Means a million apart have codes of many bits, and the products of such codes round.
TEST(PackedConversion, KeepsTheLargestErrorWhereMeansLieFarApart) {
  std::uint32_t state = 7;
  MemoryVolume volume(kPackedDomain, [&](const Index3& i) {
    state = state * 1664525U + 1013904223U;
    const float noise = std::ldexp(static_cast<float>(state >> 8U), -24);
    const bool low = i.x < 0 && i.y < 10;
    const bool high = i.x > 56 && i.y > 60;
    return low ? noise - 1e6F : high ? noise + 1e6F : 20 * smooth(i) + noise;
  });
  for (const double bound : {0.1, 0.2, 0.4, 0.8, 1.6, 3.2}) {
    const ConversionOptions options = packed(Budget::Kind::max_error, bound);
    EXPECT_LE(test::convert(volume, options).sidecar.error.max_abs, bound);
  }
}

TEST(PackedConversion, KeepsTheLargestErrorOfIntegers) {
  MemoryVolume volume(kPackedDomain, [](const Index3& i) { return std::round(100 * smooth(i)); });
  volume.info().type = ScalarType::int16;
  for (const double bound : {0.4, 1.0, 3.0, 40.0}) {
    const ConversionOptions options = packed(Budget::Kind::max_error, bound);
    const Converted converted = test::convert(volume, options);
    expect_certificate(volume, converted, options, std::to_string(bound));
    EXPECT_LE(converted.sidecar.error.max_abs, bound);
  }
}

// Blocks without any value read the background, whatever other blocks of their region read.
TEST(PackedConversion, MissingBlocksReadTheBackground) {
  MemoryVolume volume({{0, 0, 0}, {64, 64, 64}}, [](const Index3& i) {
    if (i.x < 8 && i.y < 16) return std::numeric_limits<float>::quiet_NaN();
    return i.z < 32 ? 1.0F : 30 * smooth(i) + static_cast<float>(i.x * 7 % 5);
  });
  ConversionOptions options = packed(Budget::Kind::rate, 3);
  options.non_finite = NonFinitePolicy::background;
  options.background = 7.0F;
  const Converted converted = test::convert(volume, options);
  const std::vector<float> values = decoded(converted, volume.info().domain());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(volume.values()[i])) {
      ASSERT_EQ(values[i], 7.0F) << i;
    }
  }
}

// Like a coast: the voxels on one side of a plane are missing.
TEST(PackedConversion, BlocksWithSomeMissingVoxelsAreNotStoredRaw) {
  MemoryVolume volume({{0, 0, 0}, {64, 64, 64}}, [](const Index3& i) {
    return i.x + i.y + i.z < 96 ? std::numeric_limits<float>::quiet_NaN() : smooth(i);
  });
  ConversionOptions options = packed(Budget::Kind::psnr, 60);
  options.non_finite = NonFinitePolicy::background;
  const Converted converted = test::convert(volume, options);
  expect_certificate(volume, converted, options, "coast");
  ASSERT_TRUE(converted.sidecar.selection.blocks.has_value());
  EXPECT_EQ((*converted.sidecar.selection.blocks)[4], 0U);
}

TEST(PackedConversion, KeptNaNOfOneKindTakesFiveBytesABlock) {
  MemoryVolume volume({{0, 0, 0}, {64, 64, 64}}, [](const Index3& i) {
    return i.x < 32 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(i.x / 8);
  });
  ConversionOptions options = packed(Budget::Kind::lossless, 0);
  options.non_finite = NonFinitePolicy::keep;
  options.preview = Preview::off;
  const Converted converted = test::convert(volume, options);
  EXPECT_TRUE(converted.sidecar.error.lossless);
  EXPECT_LT(converted.file.size(), 40000U);
}

TEST(PackedConversion, TheRangeHasNoNegativeZero) {
  MemoryVolume volume({{0, 0, 0}, {256, 8, 8}}, [](const Index3& i) { return i.x < 128 ? -0.0F : 0.0F; });
  for (const NonFinitePolicy policy : {NonFinitePolicy::error, NonFinitePolicy::keep}) {
    ConversionOptions options = packed(Budget::Kind::lossless, 0);
    options.non_finite = policy;
    const Converted converted = test::convert(volume, options);
    EXPECT_EQ(test::bits_of(converted.grid().value_min()), 0U);
    EXPECT_EQ(test::bits_of(converted.grid().value_max()), 0U);
  }
}

TEST(PackedConversion, LosslessOfIntegersIsShorterThanTheirBytes) {
  MemoryVolume volume(kPackedDomain, [](const Index3& i) { return std::round(100 * smooth(i)); });
  volume.info().type = ScalarType::uint16;
  const ConversionOptions options = packed(Budget::Kind::lossless, 0);
  const Converted converted = test::convert(volume, options);
  EXPECT_TRUE(converted.sidecar.error.lossless);
  expect_certificate(volume, converted, options, "integers");
  EXPECT_LT(converted.file.size(), static_cast<std::uint64_t>(kPackedDomain.voxels()) * 2);
  ASSERT_TRUE(converted.sidecar.selection.blocks.has_value());
  EXPECT_GT((*converted.sidecar.selection.blocks)[3], 0U);
}

TEST(PackedConversion, LosslessOfWholeNumbersInFloatsIsLittleLongerThanOfIntegers) {
  const auto value = [](const Index3& i) { return std::round(100 * smooth(i)) - 50; };
  MemoryVolume floats(kPackedDomain, value);
  MemoryVolume integers(kPackedDomain, value);
  integers.info().type = ScalarType::int16;
  const ConversionOptions options = packed(Budget::Kind::lossless, 0);
  const Converted converted = test::convert(floats, options);
  EXPECT_TRUE(converted.sidecar.error.lossless);
  expect_certificate(floats, converted, options, "whole numbers");
  // Each block may take one more byte, for its base.
  const auto blocks = static_cast<std::uint64_t>(make_lattice(kPackedDomain, kLeafDim).size());
  EXPECT_LE(converted.file.size(), test::convert(integers, options).file.size() + blocks + 16);
}

TEST(PackedConversion, LosslessOfNoiseIsLittleMoreThanRaw) {
  std::uint32_t state = 1;
  MemoryVolume volume(kPackedDomain, [&](const Index3&) {
    state = state * 1664525U + 1013904223U;
    return std::ldexp(static_cast<float>(state >> 8U), static_cast<int>(state & 15U) - 24);
  });
  ConversionOptions options = packed(Budget::Kind::lossless, 0);
  options.preview = Preview::off;
  const Converted converted = test::convert(volume, options);
  EXPECT_TRUE(converted.sidecar.error.lossless);
  expect_certificate(volume, converted, options, "noise");
  const NodeLattice blocks = make_lattice(kPackedDomain, kLeafDim);
  const auto raw = static_cast<double>(blocks.size() * 2048);
  EXPECT_LT(static_cast<double>(converted.file.size()), raw * 1.01 + 20000);
}

TEST(PackedConversion, BlocksWithoutNegativeValuesDecodeToNone) {
  MemoryVolume volume(kPackedDomain, [](const Index3& i) { return std::max(0.0F, smooth(i) - 2); });
  const Converted converted = test::convert(volume, packed(Budget::Kind::rate, 40));
  const std::vector<float> values = decoded(converted, kPackedDomain);
  EXPECT_GE(*std::min_element(values.begin(), values.end()), 0.0F);
}

TEST(PackedConversion, SaysWhatOtherReadersSee) {
  MemoryVolume volume(kPackedDomain, smooth);
  ConversionOptions options = packed(Budget::Kind::lossless, 0);
  options.preview = Preview::on;
  const Converted on = test::convert(volume, options);
  ASSERT_TRUE(on.sidecar.packed.has_value());
  EXPECT_TRUE(on.sidecar.packed->preview);
  // All regions have streams, so other readers see the mean of each block.
  const NodeLattice blocks = make_lattice(kPackedDomain, kLeafDim);
  double squares = 0;
  for (std::int64_t b = 0; b < blocks.size(); ++b) {
    const std::vector<float> values = volume.in(blocks.voxels(blocks.position(b)));
    double sum = 0;
    for (const float v : values) sum += static_cast<double>(v);
    const double mean = sum / static_cast<double>(values.size());
    for (const float v : values) squares += (static_cast<double>(v) - mean) * (static_cast<double>(v) - mean);
  }
  const double mse = squares / static_cast<double>(kPackedDomain.voxels());
  EXPECT_NEAR(on.sidecar.error_preview->mse, mse, mse * 1e-6);
}

class PackedHardCases : public testing::TestWithParam<test::HardCase> {};

TEST_P(PackedHardCases, KeepTheirCertificates) {
  MemoryVolume volume = GetParam().make();
  for (const NonFinitePolicy policy : test::policies_of(volume)) {
    for (const Preview preview : {Preview::on, Preview::off}) {
      ConversionOptions options = packed(Budget::Kind::lossless, 0);
      options.non_finite = policy;
      options.preview = preview;
      const Converted lossless = test::convert(volume, options);
      EXPECT_TRUE(lossless.sidecar.error.lossless);
      expect_certificate(volume, lossless, options, "lossless");
      options.budget.kind = Budget::Kind::size;
      const std::uint64_t least = test::minimum_size(volume, options);
      for (const double share : {0.02, 0.3, 0.8}) {
        // A lossless file of floats on no lattice may be smaller than a file of exact blocks under other budgets.
        const std::uint64_t more = lossless.file.size() > least ? lossless.file.size() - least : 1000;
        options.budget.bytes = least + static_cast<std::uint64_t>(static_cast<double>(more) * share);
        const Converted some = test::convert(volume, options);
        EXPECT_EQ(some.file.size(), options.budget.bytes);
        expect_certificate(volume, some, options, std::to_string(share));
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, PackedHardCases, testing::ValuesIn(test::hard_cases()),
                         [](const auto& p) { return p.param.name; });

}  // namespace
}  // namespace weir::packed_conversion_test
