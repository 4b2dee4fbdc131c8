#include "compressor/derived/derived_error.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <functional>
#include <limits>

#include "tests/compressor/support/converted.h"

namespace weir::derived_error_test {
namespace {

using Field = std::function<float(const Index3&)>;

/// Finds the derived errors of a lossless file of `kept` against `source`.
class DerivedError : public testing::Test {
 protected:
  DerivedErrors of(const Box& domain, const Field& source, const Field& kept, const CompareOptions& options = {}) {
    test::MemoryVolume made_from(domain, kept);
    ConversionOptions lossless;
    lossless.budget.kind = Budget::Kind::lossless;
    lossless.non_finite = NonFinitePolicy::keep;
    const test::Converted file = test::convert(made_from, lossless);
    test::MemoryVolume volume(domain, source);
    const Comparison compared = compare_volumes(volume, file.grid(), "out.nvdb", options);
    const DerivedErrors all = derive_errors(volume, file.grid(), compared, options);
    const GradientError alone = gradient_error(volume, file.grid(), options);
    EXPECT_EQ(alone.rms, all.gradient.rms);
    EXPECT_EQ(alone.max_abs, all.gradient.max_abs);
    return all;
  }
};

const Box kDomain{{-5, 3, -20}, {30, 20, 7}};

float wave(const Index3& i) {
  return static_cast<float>(std::sin(0.3 * static_cast<double>(i.x)) + 0.1 * static_cast<double>(i.y * i.z));
}

TEST_F(DerivedError, EqualVolumes_HaveNoErrorAndSimilarityOne) {
  const DerivedErrors all = of(kDomain, wave, wave);
  EXPECT_EQ(all.quantiles, (std::array<double, 4>{}));
  EXPECT_EQ(all.octaves.zeros, static_cast<std::uint64_t>(kDomain.voxels()));
  EXPECT_EQ(all.gradient.rms, 0);
  EXPECT_EQ(all.gradient.relative_rms, 0);
  EXPECT_EQ(all.gradient.max_abs, 0);
  EXPECT_NEAR(*all.similarity.mean, 1, 1e-12);
}

// The differences of a linear function equal its slope, also at the faces.
TEST_F(DerivedError, GradientOfALinearErrorIsItsSlope) {
  const Field ramp = [](const Index3& i) { return static_cast<float>(4 * i.x - 2 * i.y + i.z); };
  const Field steeper = [&](const Index3& i) { return ramp(i) + 0.5F * static_cast<float>(i.x); };
  const DerivedErrors all = of(kDomain, ramp, steeper);
  EXPECT_EQ(all.gradient.voxels, static_cast<std::uint64_t>(kDomain.voxels()));
  EXPECT_DOUBLE_EQ(all.gradient.rms, 0.5);
  EXPECT_DOUBLE_EQ(all.gradient.max_abs, 0.5);
  EXPECT_DOUBLE_EQ(*all.gradient.relative_rms, 0.5 / std::sqrt(21.0));
}

TEST_F(DerivedError, OneWrongVoxelIsSeenByItsNeighbours) {
  const Index3 wrong{4, 9, 0};
  const Field kept = [&](const Index3& i) { return wave(i) + (i == wrong ? 2.0F : 0.0F); };
  const DerivedErrors all = of(kDomain, wave, kept);
  EXPECT_NEAR(all.gradient.max_abs, 1, 1e-5);
  EXPECT_NEAR(all.gradient.rms, std::sqrt(6.0 / static_cast<double>(kDomain.voxels())), 1e-6);
  EXPECT_EQ(all.quantiles[2], 0);
  EXPECT_LT(*all.similarity.mean, 1);
}

TEST_F(DerivedError, AxesOfOneVoxelHaveNoSlope) {
  const Field zero = [](const Index3&) { return 0.0F; };
  const Field line = [](const Index3& i) { return static_cast<float>(i.x * 3); };
  const DerivedErrors all = of({{0, 0, 0}, {9, 1, 1}}, zero, line);
  EXPECT_DOUBLE_EQ(all.gradient.max_abs, 3);
  EXPECT_EQ(all.gradient.relative_rms, std::nullopt);
  EXPECT_EQ(all.similarity.mean, std::nullopt);  // the volume has one value
}

TEST_F(DerivedError, VoxelsBesideOnesThatAreNotFiniteAreLeftOut) {
  const Index3 bad{0, 10, -10};
  const Field source = [&](const Index3& i) { return i == bad ? std::numeric_limits<float>::quiet_NaN() : wave(i); };
  const DerivedErrors all = of(kDomain, source, wave);
  EXPECT_EQ(all.gradient.left_out, 6U);
  EXPECT_EQ(all.gradient.voxels, static_cast<std::uint64_t>(kDomain.voxels()) - 6);
  EXPECT_EQ(all.octaves.zeros, static_cast<std::uint64_t>(kDomain.voxels()) - 1);
  EXPECT_GT(all.similarity.left_out, 0U);
  EXPECT_NEAR(*all.similarity.mean, 1, 1e-12);
}

// No difference is taken along an axis of one voxel, so a voxel's own value does not count. numpy.gradient of nine
// values, one of them not finite, has seven finite values.
TEST_F(DerivedError, OfALineOnlyTheNeighboursOfAValueThatIsNotFiniteAreLeftOut) {
  const Field source = [](const Index3& i) {
    return i.x == 4 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(i.x * i.x);
  };
  const Field kept = [](const Index3& i) { return static_cast<float>(i.x * i.x); };
  const DerivedErrors all = of({{0, 0, 0}, {9, 1, 1}}, source, kept);
  EXPECT_EQ(all.gradient.voxels, 7U);
  EXPECT_EQ(all.gradient.left_out, 2U);
}

// Windows begin at 0 and at 3 along each axis. 7 of the 8 windows have a voxel of index 8 or above.
TEST_F(DerivedError, WindowsReachTheUpperFaces) {
  for (const Index3& lo : {Index3{0, 0, 0}, Index3{-5, 3, 6}}) {
    const Field kept = [&](const Index3& i) {
      const Index3 at = i - lo;
      return std::max({at.x, at.y, at.z}) >= 8 ? -wave(i) : wave(i);
    };
    const DerivedErrors all = of({lo, lo + Index3{11, 11, 11}}, wave, kept);
    EXPECT_EQ(all.similarity.windows, 8U);
    EXPECT_LT(*all.similarity.mean, 0.9);
    EXPECT_GT(*all.similarity.mean, -0.75);  // the similarity of the lowest window is 1
  }
  EXPECT_EQ(of({{0, 0, 0}, {8, 12, 5}}, wave, wave).similarity.windows, 2U);
  EXPECT_EQ(of({{0, 0, 0}, {9, 13, 21}}, wave, wave).similarity.windows, 2U * 3 * 5);
}

TEST_F(DerivedError, DependsNeitherOnBlocksNorOnThreads) {
  const Box domain{{-3, 0, 5}, {140, 37, 60}};
  const Field kept = [](const Index3& i) { return wave(i) + 0.01F * static_cast<float>((i.x * 7 + i.y * i.z) % 11); };
  const DerivedErrors whole = of(domain, wave, kept);
  CompareOptions small;
  small.block_bytes = 16384;
  const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  const DerivedErrors pieces = of(domain, wave, kept, small);
  EXPECT_EQ(whole.quantiles, pieces.quantiles);
  EXPECT_EQ(whole.gradient.rms, pieces.gradient.rms);
  EXPECT_EQ(whole.gradient.max_abs, pieces.gradient.max_abs);
  EXPECT_EQ(whole.similarity.windows, pieces.similarity.windows);
  EXPECT_EQ(whole.similarity.mean, pieces.similarity.mean);
}

}  // namespace
}  // namespace weir::derived_error_test
