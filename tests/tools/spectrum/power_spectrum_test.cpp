#include "tools/spectrum/power_spectrum.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "compressor/conversion.h"
#include "format/io/memory_file_system.h"
#include "ingest/values/array_source.h"
#include "tools/spectrum/block_transform.h"

namespace weir::power_spectrum_test {
namespace {

using Field = std::function<double(const Index3&)>;
using Shell = PowerSpectrum::Shell;

class PowerSpectrumTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_fftw()) GTEST_SKIP() << "this build has no FFTW";
  }

  std::vector<float> values_of(const Field& field) const {
    std::vector<float> values;
    for_each_index({{}, extent_}, [&](const Index3& i) { values.push_back(static_cast<float>(field(i))); });
    return values;
  }

  std::unique_ptr<VolumeSource> open(const std::vector<float>& values) const {
    DenseArray array;
    array.extent = extent_;
    array.type = ScalarType::float32;
    array.spacing = spacing_;
    array.data = values.data();
    array.stride = packed_stride(extent_, array.type);
    return open_array(array);
  }

  /// Returns the spectrum of `source` and of a file with the values `kept`.
  PowerSpectrum of(const Field& source, const Field& kept, const CompareOptions& options = {}) const {
    const std::vector<float> kept_values = values_of(kept);
    ConversionOptions lossless;
    lossless.output = "a.nvdb";
    lossless.budget.kind = Budget::Kind::lossless;
    lossless.non_finite = NonFinitePolicy::keep;
    lossless.resume = Resume::off;
    MemoryFileSystem files;
    convert_volume(*open(kept_values), lossless, {}, files);
    const std::vector<float> values = values_of(source);
    return power_spectrum(*open(values), NvdbGrid::open(files.content("a.nvdb"), "a.nvdb"), options);
  }
  PowerSpectrum of(const Field& source) const { return of(source, source); }

  Index3 extent_{64, 64, 64};
  std::array<double, 3> spacing_{1, 1, 1};
};

// Returns uncorrelated noise of variance 1.
double noise(const Index3& i) {
  auto bits = static_cast<std::uint64_t>(i.x + 1000 * i.y + 1000000 * i.z) + 1;
  for (int round = 0; round < 3; ++round) {  // splitmix64
    bits += 0x9e3779b97f4a7c15U;
    bits = (bits ^ bits >> 30U) * 0xbf58476d1ce4e5b9U;
    bits = (bits ^ bits >> 27U) * 0x94d049bb133111ebU;
    bits ^= bits >> 31U;
  }
  return std::sqrt(3.0) * (2 * (static_cast<double>(bits >> 11U) * 0x1p-53) - 1);
}

double total(const PowerSpectrum& spectrum) {
  double sum = 0;
  for (const Shell& shell : spectrum.shells) sum += shell.source;
  return sum;
}

// Hann's window puts two thirds of a wave's power at its own frequency and a sixth at each neighbour.
TEST_F(PowerSpectrumTest, AWaveIsInTheShellOfItsNumber) {
  extent_ = {160, 70, 64};
  spacing_ = {0.5, 0.5, 0.5};
  const PowerSpectrum found =
      of([](const Index3& i) { return 3 + std::cos(2 * std::numbers::pi * 8 * static_cast<double>(i.x) / 64); });
  EXPECT_EQ(found.block, (Index3{64, 64, 64}));
  EXPECT_EQ(found.blocks, 8U);
  ASSERT_GT(found.shells.size(), 50U);
  EXPECT_NEAR(total(found), 0.5, 1e-5);
  for (const Shell& shell : found.shells) {
    const double number = shell.wave_number * 32;  // cycles in a block
    const double expected = number == 8 ? 1.0 / 3 : number == 7 || number == 9 ? 1.0 / 12 : 0;
    EXPECT_NEAR(shell.source, expected, 1e-5) << number;
    EXPECT_EQ(shell.source, shell.decoded);
    EXPECT_EQ(shell.error, 0);
  }
}

TEST_F(PowerSpectrumTest, WhiteNoiseHasTheSamePowerInEveryMode) {
  extent_ = {128, 96, 96};
  const PowerSpectrum found = of(noise);
  EXPECT_EQ(found.blocks, 12U);
  EXPECT_NEAR(total(found), 1, 0.01);
  std::uint64_t modes = 0;
  for (const Shell& shell : found.shells) {
    modes += shell.modes;
    if (shell.modes > 1000 && shell.wave_number > 2.0 / 64) {
      EXPECT_NEAR(shell.source / static_cast<double>(shell.modes) * 262144, 1, 0.1) << shell.wave_number;
    }
  }
  EXPECT_EQ(modes, 262143U);  // all but the mean
}

TEST_F(PowerSpectrumTest, PowersSumUpToTheVarianceUnderTheWindow) {
  extent_ = {33, 64, 20};
  const PowerSpectrum found = of([](const Index3& i) { return noise(i) + 0.1 * static_cast<double>(i.y); });
  ASSERT_EQ(found.blocks, 1U);
  double weights = 0;
  double sum = 0;
  double squares = 0;
  double squared_weights = 0;
  const auto each = [&](const auto& visit) {
    for_each_index({{}, extent_}, [&](const Index3& i) {
      const auto hann = [](std::int64_t n, std::int64_t of) {
        return 0.5 - 0.5 * std::cos(2 * std::numbers::pi * (static_cast<double>(n) + 0.5) / static_cast<double>(of));
      };
      const auto value = static_cast<double>(static_cast<float>(noise(i) + 0.1 * static_cast<double>(i.y)));
      visit(hann(i.x, 33) * hann(i.y, 64) * hann(i.z, 20), value);
    });
  };
  each([&](double weight, double value) {
    weights += weight;
    sum += weight * value;
  });
  each([&](double weight, double value) {
    squared_weights += weight * weight;
    squares += weight * weight * (value - sum / weights) * (value - sum / weights);
  });
  EXPECT_NEAR(total(found) / (squares / squared_weights), 1, 1e-9);
}

TEST_F(PowerSpectrumTest, OfAFileThatHalvesAllValues) {
  const PowerSpectrum found =
      of(noise, [](const Index3& i) { return 0.5 * static_cast<double>(static_cast<float>(noise(i))); });
  for (const Shell& shell : found.shells) {
    EXPECT_NEAR(shell.decoded / shell.source, 0.25, 1e-9);
    EXPECT_NEAR(shell.error / shell.source, 0.25, 1e-9);
  }
}

// Along an axis with voxels twice as long, the wave number is half as large.
TEST_F(PowerSpectrumTest, WaveNumbersAreOfTheWorld) {
  spacing_ = {1, 1, 2};
  const PowerSpectrum found =
      of([](const Index3& i) { return std::cos(2 * std::numbers::pi * 16 * static_cast<double>(i.z) / 64); });
  for (const Shell& shell : found.shells) {
    if (shell.wave_number == 8.0 / 64) {
      EXPECT_NEAR(shell.source, 0.5, 0.2);
    } else if (shell.wave_number > 10.0 / 64) {
      EXPECT_NEAR(shell.source, 0, 1e-6) << shell.wave_number;
    }
  }
}

// The shell width follows the longest axis: two planes do not merge all wave numbers into one shell.
TEST_F(PowerSpectrumTest, ShellsOfAThinVolumeAreAsNarrowAsItsLongestAxisHasThem) {
  extent_ = {128, 128, 2};
  const PowerSpectrum found =
      of([](const Index3& i) { return std::cos(2 * std::numbers::pi * 8 * static_cast<double>(i.x) / 64); });
  EXPECT_EQ(found.block, (Index3{64, 64, 2}));
  ASSERT_GT(found.shells.size(), 40U);
  EXPECT_EQ(found.shells[0].wave_number, 1.0 / 64);
  EXPECT_EQ(found.shells[0].lowest, 1.0 / 64);
  EXPECT_NEAR(found.shells[7].source, 1.0 / 3, 1e-5);
  EXPECT_NEAR(found.shells[20].source, 0, 1e-6);
}

TEST_F(PowerSpectrumTest, ShellsAreNotTooManyWhateverTheSpacing) {
  spacing_ = {1, 1, 1e4};
  const PowerSpectrum found = of(noise);
  EXPECT_LE(found.shells.size(), 512U);
  EXPECT_EQ(found.shells[0].lowest, 1 / 64e4);
  EXPECT_NEAR(total(found), 1, 0.05);
  for (std::size_t i = 0; i < found.shells.size(); ++i) {
    const Shell& shell = found.shells[i];
    EXPECT_GT(shell.modes, 0U);
    EXPECT_LE(shell.lowest, shell.wave_number + 1 / 1024.0);
    if (i > 0) {
      EXPECT_GT(shell.lowest, found.shells[i - 1].wave_number);
    }
  }
}

TEST_F(PowerSpectrumTest, BlocksReachTheUpperFaces) {
  extent_ = {95, 95, 95};
  const PowerSpectrum found = of(noise, [](const Index3& i) {
    return std::max({i.x, i.y, i.z}) >= 64 ? 0 : static_cast<double>(static_cast<float>(noise(i)));
  });
  EXPECT_EQ(found.blocks, 8U);
  double error = 0;
  for (const Shell& shell : found.shells) error += shell.error;
  EXPECT_GT(error / total(found), 0.1);
}

TEST_F(PowerSpectrumTest, BlocksWithAValueThatIsNotFiniteAreLeftOut) {
  extent_ = {96, 64, 64};
  const PowerSpectrum found = of([](const Index3& i) {
    return i == Index3{3, 3, 3} ? std::numeric_limits<double>::quiet_NaN() : noise(i);
  });
  EXPECT_EQ(found.blocks, 1U);
  EXPECT_EQ(found.left_out, 1U);
  EXPECT_NEAR(total(found), 1, 0.05);
}

TEST_F(PowerSpectrumTest, OfVolumesOfFewVoxels) {
  extent_ = {1, 1, 1};
  EXPECT_TRUE(of(noise).shells.empty());
  extent_ = {2, 1, 1};
  const PowerSpectrum two = of([](const Index3& i) { return static_cast<double>(i.x); });
  ASSERT_EQ(two.shells.size(), 1U);
  EXPECT_DOUBLE_EQ(two.shells[0].wave_number, 0.5);
  EXPECT_DOUBLE_EQ(two.shells[0].source, 0.25);
}

TEST_F(PowerSpectrumTest, DependsNeitherOnBlocksNorOnThreads) {
  extent_ = {140, 70, 66};
  const auto kept = [](const Index3& i) { return noise(i) * 0.99; };
  const PowerSpectrum whole = of(noise, kept);
  CompareOptions small;
  small.block_bytes = std::uint64_t{256} << 10U;
  const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  const PowerSpectrum pieces = of(noise, kept, small);
  ASSERT_EQ(whole.shells.size(), pieces.shells.size());
  for (std::size_t i = 0; i < whole.shells.size(); ++i) {
    EXPECT_EQ(whole.shells[i].source, pieces.shells[i].source);
    EXPECT_EQ(whole.shells[i].decoded, pieces.shells[i].decoded);
    EXPECT_EQ(whole.shells[i].error, pieces.shells[i].error);
  }
}

}  // namespace
}  // namespace weir::power_spectrum_test
