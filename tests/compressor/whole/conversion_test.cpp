// Whole conversions of the hard cases. The certificate and the sidecar agree with what the stock reader finds, whatever
// the threads, the memory and the way of reading the volume.
#include "compressor/conversion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <regex>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "tests/compressor/support/converted.h"
#include "tests/compressor/support/hard_cases.h"
#include "tests/compressor/support/measured.h"

namespace weir::conversion_test {
namespace {

using test::Converted;
using test::HardCase;
using test::Measured;
using test::MemoryVolume;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

class HardCaseTest : public testing::TestWithParam<HardCase> {};

TEST_P(HardCaseTest, CertificateIsWhatTheStockReaderFinds) {
  MemoryVolume volume = GetParam().make();
  const auto voxels = static_cast<std::uint64_t>(volume.info().domain().voxels());
  for (const NonFinitePolicy policy : test::policies_of(volume)) {
    for (const FillMode fill : {FillMode::mean, FillMode::background}) {
      ConversionOptions options;
      options.non_finite = policy;
      options.fill = fill;
      SCOPED_TRACE(policy_name(policy) + ", fill " + fill_name(fill));
      const std::uint64_t minimum = test::minimum_size(volume, options);
      options.budget.kind = Budget::Kind::lossless;
      const std::uint64_t lossless = test::convert(volume, options).file.size();
      for (const std::uint64_t size : {minimum, minimum + (lossless - minimum) / 2, lossless}) {
        const Converted converted = test::convert_to(volume, options, size);
        ASSERT_EQ(converted.file.size(), size);
        const Measured measured = test::measure(volume, converted, policy);
        test::expect_certificate(converted, measured);
        EXPECT_EQ(converted.sidecar.nonfinite.count, voxels - measured.finite);
        EXPECT_EQ(converted.sidecar.selection.leaves_kept, converted.grid().node_counts()[0]);
        EXPECT_TRUE(measured.lossless || size < lossless);
        if (HasFailure()) return;
      }
    }
  }
}

TEST_P(HardCaseTest, ThePapersPresetHolds) {
  MemoryVolume volume = GetParam().make();
  for (const NonFinitePolicy policy : test::policies_of(volume)) {
    ConversionOptions options;
    options.non_finite = policy;
    options.fill = FillMode::background;
    options.metric = Metric::farthest;
    options.paper_background = true;
    const std::uint64_t minimum = test::minimum_size(volume, options);
    const Converted converted = test::convert_to(volume, options, minimum + 40 * 2144);
    EXPECT_TRUE(std::isfinite(converted.grid().background()));
    test::expect_certificate(converted, test::measure(volume, converted, policy));
  }
}

TEST_P(HardCaseTest, BytesDoNotDependOnThreadsMemoryOrAccess) {
  MemoryVolume volume = GetParam().make();
  struct Way {
    NonFinitePolicy policy;
    Encoding encoding;
  };
  std::vector<Way> ways;
  for (const NonFinitePolicy policy : test::policies_of(volume)) {
    ways.push_back({policy, Encoding::float32});
    if (policy != NonFinitePolicy::keep) ways.push_back({policy, Encoding::fpn});
  }
  for (const auto& [policy, encoding] : ways) {
    SCOPED_TRACE(policy_name(policy) + ", " + encoding_name(encoding));
    ConversionOptions options;
    options.non_finite = policy;
    options.encoding = encoding;
    options.threads = 2;
    const std::uint64_t minimum = test::minimum_size(volume, options);
    options.budget.kind = Budget::Kind::size;
    options.budget.bytes = minimum + 45 * 2144 + 7;
    const Converted expected = test::convert(volume, options);
    const auto expect_same = [&](const std::string& what) {
      const Converted found = test::convert(volume, options);
      EXPECT_TRUE(found.file == expected.file) << what;
      EXPECT_EQ(found.sidecar.source.digest, expected.sidecar.source.digest) << what;
      EXPECT_EQ(found.sidecar.file.digest, expected.sidecar.file.digest) << what;
      EXPECT_EQ(found.sidecar.error.mse, expected.sidecar.error.mse) << what;
      EXPECT_EQ(found.sidecar.histogram.counts, expected.sidecar.histogram.counts) << what;
    };
    for (const std::size_t threads : {1U, 4U, 7U}) {
      options.threads = threads;
      expect_same(std::to_string(threads) + " threads");
    }
    options.threads = 3;
    for (const std::int64_t chunk : {8, 16, 24}) {
      volume.set_access({4, {chunk, 2 * chunk, chunk}, {0, 0, 0}});
      expect_same("chunks of " + std::to_string(chunk));
    }
    volume.set_access({});
    // The least possible memory.
    options.memory = 1;
    try {
      test::convert(volume, options);
      FAIL();
    } catch (const Error& error) {
      const std::string message = error.what();
      std::smatch match;
      ASSERT_TRUE(std::regex_search(message, match, std::regex("give at least ([0-9]+)MiB"))) << message;
      options.memory = (std::stoull(match[1]) + 8) << 20U;
    }
    expect_same("little memory");
  }
}

INSTANTIATE_TEST_SUITE_P(Volumes, HardCaseTest, testing::ValuesIn(test::hard_cases()),
                         [](const auto& parameter) { return parameter.param.name; });

TEST(Conversion, RefusesNonFiniteValuesByDefaultWithCountAndPlace) {
  MemoryVolume volume({{-5, 2, 0}, {40, 30, 20}}, [](const Index3& i) {
    return i == Index3{-3, 7, 1} ? -kInf : i == Index3{11, 6, 2} || i == Index3{-4, 8, 1} ? kNaN : 1.0F;
  });
  for (const std::size_t threads : {1U, 7U}) {
    ConversionOptions options;
    options.threads = threads;
    try {
      test::convert(volume, options);
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_STREQ(error.what(),
                   "memory: 3 voxels are NaN or infinite, the first (-inf) at -3,7,1; choose --nonfinite background or "
                   "--nonfinite keep");
    }
  }
}

TEST(Conversion, ConstantVolumesAreLosslessInTheSmallestTree) {
  for (const float value : {0.0F, -0.0F, 5.5F, 1e30F}) {
    MemoryVolume volume({{0, 0, 0}, {300, 140, 130}}, [&](const Index3&) { return value; });
    ConversionOptions options;
    options.budget.kind = Budget::Kind::lossless;
    const Converted converted = test::convert(volume, options);
    EXPECT_EQ(converted.file.size(), test::minimum_size(volume, options));
    EXPECT_TRUE(converted.sidecar.error.lossless);
    EXPECT_EQ(converted.sidecar.selection.leaves_kept, 2U);
    EXPECT_EQ(converted.grid().node_counts()[1], 2U);
  }
}

TEST(Conversion, UserBackgroundCountsOutsideAndInFill) {
  MemoryVolume volume({{0, 0, 0}, {60, 20, 20}}, [](const Index3& i) { return static_cast<float>(i.x); });
  ConversionOptions options;
  options.background = -3.5F;
  options.fill = FillMode::background;
  const Converted converted = test::convert_to(volume, options, test::minimum_size(volume, options));
  EXPECT_EQ(converted.sidecar.background.value, -3.5);
  EXPECT_EQ(converted.sidecar.background.method, "user");
  EXPECT_EQ(converted.grid().value({-1, 0, 0}), -3.5F);
  EXPECT_EQ(converted.grid().value({30, 10, 10}), -3.5F);
  EXPECT_EQ(converted.sidecar.error.max_abs, 59 + 3.5);
}

}  // namespace
}  // namespace weir::conversion_test
