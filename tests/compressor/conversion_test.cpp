// Whole conversions of the hard cases: what the certificate and the sidecar say
// is what the stock reader finds, whatever the threads, the memory and the way
// the volume is read.
#include "compressor/conversion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <functional>
#include <limits>
#include <ostream>
#include <regex>
#include <string>
#include <vector>

#include "format/error.h"
#include "ingest/synthetic/synthetic.h"
#include "tests/compressor/converted.h"
#include "tests/compressor/stock_tree.h"

namespace weir {
namespace {

using test::bits_of;
using test::Converted;
using test::MemoryVolume;
using test::StockReader;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

struct HardCase {
  std::string name;
  std::function<MemoryVolume()> make;
};

std::ostream& operator<<(std::ostream& out, const HardCase& c) { return out << c.name; }

HardCase synthetic(const std::string& name, const std::string& kind, const Index3& extent) {
  return {name, [kind, extent] {
            const auto source = open_synthetic(kind, {extent, 5});
            return MemoryVolume(*source);
          }};
}

HardCase field(const std::string& name, const Box& domain, const std::function<float(const Index3&)>& value) {
  return {name, [domain, value] { return MemoryVolume(domain, value); }};
}

std::vector<HardCase> hard_cases() {
  std::vector<HardCase> cases;
  for (const SyntheticKind& kind : synthetic_kinds()) {
    std::string name;
    bool upper = true;
    for (const char c : kind.name) {
      if (c != '-') name += upper ? static_cast<char>(std::toupper(c)) : c;
      upper = c == '-';
    }
    cases.push_back(synthetic(name, std::string(kind.name), {45, 30, 25}));
  }
  cases.push_back(synthetic("CloudOfManyRegions", "cloud", {150, 140, 20}));
  cases.push_back(synthetic("HotVoxelOfManyRegions", "hot-voxel", {270, 140, 20}));
  cases.push_back(synthetic("OneVoxel", "noise", {1, 1, 1}));
  cases.push_back(synthetic("AlongX", "noise", {300, 1, 1}));
  cases.push_back(synthetic("AlongY", "noise", {1, 300, 1}));
  cases.push_back(synthetic("AlongZ", "noise", {1, 1, 300}));
  cases.push_back(field("OneNaN", {{0, 0, 0}, {1, 1, 1}}, [](const Index3&) { return kNaN; }));
  cases.push_back(
      field("AllInfinite", {{0, 0, 0}, {20, 9, 9}}, [](const Index3& i) { return i.x < 10 ? kInf : -kInf; }));
  cases.push_back(field("RegionOfNaN", {{0, 0, 0}, {300, 20, 20}},
                        [](const Index3& i) { return i.x >= 128 && i.x < 256 ? kNaN : static_cast<float>(i.x % 7); }));
  cases.push_back(field("SignedNaNPayloads", {{0, 0, 0}, {24, 16, 16}}, [](const Index3& i) {
    return i.x % 5 == 0 ? std::bit_cast<float>(0xFFC12345U + static_cast<std::uint32_t>(i.y)) : 2.0F;
  }));
  cases.push_back(field("LeavesOf511EqualValues", {{-8, 0, 0}, {40, 24, 24}}, [](const Index3& i) {
    return (i.x & 7) == 3 && i.y % 8 == 4 && i.z % 8 == 5 ? 1.0F + 0x1p-23F : 1.0F;
  }));
  cases.push_back(field("NegativeZeroRegions", {{0, 0, 0}, {400, 9, 9}}, [](const Index3& i) {
    return i.x < 128 || i.x >= 384 ? 1.0F : i.x < 256 ? -0.0F : i.y < 5 ? -0.0F : 0.0F;
  }));
  cases.push_back(field("UniformRegionsBelowZero", {{-300, -9, -9}, {-1, 0, 0}},
                        [](const Index3& i) { return i.x < -128 ? -7.5F : static_cast<float>(i.z); }));
  cases.push_back(field("LargestFloats", {{0, 0, 0}, {30, 10, 10}}, [](const Index3& i) {
    const float most = std::numeric_limits<float>::max();
    return i.x % 3 == 0 ? most : i.x % 3 == 1 ? -most : 0x1p-149F;
  }));
  return cases;
}

bool all_finite(const MemoryVolume& volume) {
  return std::all_of(volume.values().begin(), volume.values().end(), [](float v) { return std::isfinite(v); });
}

std::vector<NonFinitePolicy> policies_of(const MemoryVolume& volume) {
  if (all_finite(volume)) return {NonFinitePolicy::error};
  return {NonFinitePolicy::background, NonFinitePolicy::keep};
}

struct Measured {
  std::uint64_t finite = 0;
  double mse = 0;
  double max_abs = 0;
  bool lossless = true;
  float min = 0;
  float max = 0;
};

Measured measure(const MemoryVolume& volume, const Converted& converted, NonFinitePolicy policy) {
  const StockReader reader(converted.file);
  EXPECT_TRUE(reader.valid());
  EXPECT_EQ(reader.index_bbox(), volume.info().domain());
  const float background = converted.grid().background();
  Measured measured;
  long double squares = 0;
  const Box domain = volume.info().domain();
  for (std::int64_t n = 0; n < domain.voxels(); ++n) {
    const Index3 i = domain.lo + index_at(n, domain.extent());
    const float v = volume.at(i);
    const float read = reader.value(i);
    const bool replaced = !std::isfinite(v) && policy == NonFinitePolicy::background;
    measured.lossless = measured.lossless && bits_of(read) == bits_of(replaced ? background : v);
    if (!std::isfinite(v)) continue;
    measured.min = measured.finite == 0 ? v : std::min(measured.min, v);
    measured.max = measured.finite == 0 ? v : std::max(measured.max, v);
    ++measured.finite;
    const long double d = std::abs(static_cast<long double>(v) - static_cast<long double>(read));
    squares += d * d;
    measured.max_abs = std::max(measured.max_abs, static_cast<double>(d));
  }
  if (measured.finite > 0) measured.mse = static_cast<double>(squares / static_cast<long double>(measured.finite));
  return measured;
}

void expect_certificate(const Sidecar& sidecar, const Measured& measured) {
  const auto& error = sidecar.error;
  EXPECT_NEAR(error.mse, measured.mse, measured.mse * 1e-12);
  EXPECT_NEAR(error.rmse, std::sqrt(measured.mse), std::sqrt(measured.mse) * 1e-12);
  EXPECT_EQ(error.max_abs, measured.max_abs);
  EXPECT_EQ(error.lossless, measured.lossless);
  const double range = static_cast<double>(measured.max) - static_cast<double>(measured.min);
  EXPECT_EQ(sidecar.value_range[0], static_cast<double>(measured.min));
  EXPECT_EQ(sidecar.value_range[1], static_cast<double>(measured.max));
  EXPECT_EQ(error.psnr_db.has_value(), measured.mse > 0 && range > 0);
  if (error.psnr_db) {
    EXPECT_NEAR(*error.psnr_db, 20 * std::log10(range) - 10 * std::log10(measured.mse), 1e-9);
    const double unit = std::sqrt(measured.mse) / range;
    EXPECT_NEAR(error.nmse, unit * unit, unit * unit * 1e-12);
  }
}

class HardCaseTest : public testing::TestWithParam<HardCase> {};

TEST_P(HardCaseTest, CertificateIsWhatTheStockReaderFinds) {
  MemoryVolume volume = GetParam().make();
  const auto voxels = static_cast<std::uint64_t>(volume.info().domain().voxels());
  for (const NonFinitePolicy policy : policies_of(volume)) {
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
        const Measured measured = measure(volume, converted, policy);
        expect_certificate(converted.sidecar, measured);
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
  for (const NonFinitePolicy policy : policies_of(volume)) {
    ConversionOptions options;
    options.non_finite = policy;
    options.fill = FillMode::background;
    options.metric = Metric::farthest;
    options.paper_background = true;
    const std::uint64_t minimum = test::minimum_size(volume, options);
    const Converted converted = test::convert_to(volume, options, minimum + 40 * 2144);
    EXPECT_TRUE(std::isfinite(converted.grid().background()));
    expect_certificate(converted.sidecar, measure(volume, converted, policy));
  }
}

TEST_P(HardCaseTest, BytesDoNotDependOnThreadsMemoryOrAccess) {
  MemoryVolume volume = GetParam().make();
  for (const NonFinitePolicy policy : policies_of(volume)) {
    ConversionOptions options;
    options.non_finite = policy;
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
    for (const std::size_t threads : {1U, 7U}) {
      options.threads = threads;
      expect_same(std::to_string(threads) + " threads");
    }
    options.threads = 3;
    for (const std::int64_t chunk : {8, 16, 24}) {
      volume.set_access({4, {chunk, 2 * chunk, chunk}, {0, 0, 0}});
      expect_same("chunks of " + std::to_string(chunk));
    }
    volume.set_access({});
    // The least memory there is.
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

INSTANTIATE_TEST_SUITE_P(Volumes, HardCaseTest, testing::ValuesIn(hard_cases()),
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
}  // namespace weir
