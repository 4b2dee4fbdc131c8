// Packed files that keep nearly everything: near rungs and ordered floats beyond the reach of transforms, and budgets
// next to lossless.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "tests/compressor/support/converted.h"
#include "tests/compressor/support/memory_volume.h"
#include "tests/compressor/support/packed_files.h"
#include "tests/support/sanitized.h"

namespace weir::packed_near_lossless_test {
namespace {

using test::Converted;
using test::expect_certificate;
using test::kPackedDomain;
using test::MemoryVolume;
using test::packed;
using test::smooth;

// Errors at these PSNRs are far below what the sums of selection resolve.
TEST(PackedNearLossless, ReachesAPsnrNextToLossless) {
  MemoryVolume volume(kPackedDomain, smooth);
  for (const double psnr : {140.0, 200.0, 260.0}) {
    const Converted converted = test::convert(volume, packed(Budget::Kind::psnr, psnr));
    EXPECT_TRUE(converted.sidecar.error.lossless || converted.sidecar.error.psnr_db.value_or(0) >= psnr) << psnr;
  }
}

TEST(PackedNearLossless, KeepsEveryBitOfFloatsWhereTheBudgetHasRoom) {
  MemoryVolume volume(kPackedDomain, smooth);
  const Converted lossless = test::convert(volume, packed(Budget::Kind::lossless, 0));
  const ConversionOptions options = packed(Budget::Kind::size, static_cast<double>(lossless.file.size()));
  EXPECT_TRUE(test::convert(volume, options).sidecar.error.lossless);
}

TEST(PackedNearLossless, IsNearlyLosslessWhereTransformsEnd) {
  MemoryVolume volume(kPackedDomain, smooth);
  const Converted lossless = test::convert(volume, packed(Budget::Kind::lossless, 0));
  const ConversionOptions options = packed(Budget::Kind::size, 0.9 * static_cast<double>(lossless.file.size()));
  const Converted converted = test::convert(volume, options);
  EXPECT_GT(converted.sidecar.error.psnr_db, 145);
  const auto& blocks = *converted.sidecar.selection.blocks;
  EXPECT_GT(blocks[1 + static_cast<std::size_t>(PackedKind::lattice)],
            blocks[1 + static_cast<std::size_t>(PackedKind::transform)]);
  expect_certificate(volume, converted, options, "nearly lossless");
}

TEST(PackedNearLossless, BlocksOfALargerVolumeAreNearlyLosslessToo) {
  // The volume has more leaves than the survey builds near rungs for.
  const Box domain{{0, 0, 0}, {168, 144, 120}};
  MemoryVolume volume(domain, smooth);
  ASSERT_GT(domain.voxels() / kLeafVoxels, 2 * 2048);
  const ConversionOptions options = packed(Budget::Kind::psnr, 140);
  const Converted converted = test::convert(volume, options);
  EXPECT_GE(converted.sidecar.error.psnr_db, 140);
  EXPECT_LT(converted.sidecar.error.psnr_db, 142);
  EXPECT_LT(converted.file.size(), test::convert(volume, packed(Budget::Kind::lossless, 0)).file.size());
  expect_certificate(volume, converted, options, "140 dB");
  ConversionOptions other = options;
  other.threads = 1;
  EXPECT_TRUE(test::convert(volume, other).file == converted.file);
}

// Waves of many lengths, so that each further bit of accuracy costs bytes.
float rough(const Index3& i) {
  const auto x = static_cast<double>(i.x);
  const auto y = static_cast<double>(i.y);
  const auto z = static_cast<double>(i.z);
  double sum = 0;
  for (int octave = 0; octave < 5; ++octave) {
    const double k = 0.13 * std::exp2(octave);
    sum += std::sin(k * x + octave) * std::cos(k * 1.1 * y - z * k * 0.7) / std::exp2(octave);
  }
  return static_cast<float>(sum + 2.5);
}

float with_missing(const Index3& i) {
  return (i.x * 7 + i.y * 13 + i.z * 29) % 317 == 0 ? std::numeric_limits<float>::quiet_NaN() : rough(i);
}

float gradient(const Index3& i) { return static_cast<float>(i.x * 3 + i.y * 5 + i.z * 7) / 1000.0F; }

struct NearVolume {
  const char* name;
  float (*value)(const Index3&);
};

class PackedPsnr : public testing::TestWithParam<NearVolume> {};

// The volumes have more leaves than the survey builds near rungs for.
TEST_P(PackedPsnr, FilesGrowWithItAndAreNeverLongerThanLossless) {
  MemoryVolume volume({{0, 0, 0}, {168, 144, 120}}, GetParam().value);
  ConversionOptions options = packed(Budget::Kind::lossless, 0);
  options.threads = 2;
  options.non_finite = NonFinitePolicy::background;
  const std::uint64_t lossless = test::convert(volume, options).file.size();
  options.budget.kind = Budget::Kind::psnr;
  std::uint64_t last = 0;
  const std::vector<double> all{110, 120, 126, 130, 134, 138, 142, 150, 180, 220};
  for (const double psnr : kSanitized ? std::vector<double>{120, 132, 180} : all) {
    options.budget.target = psnr;
    const Converted converted = test::convert(volume, options);
    const std::uint64_t bytes = converted.file.size();
    EXPECT_GE(converted.sidecar.error.psnr_db.value_or(1e9), psnr);
    EXPECT_GE(bytes, last) << psnr;
    EXPECT_LE(bytes, lossless + lossless / 500) << psnr;
    last = bytes;
  }
}

INSTANTIATE_TEST_SUITE_P(Volumes, PackedPsnr,
                         testing::Values(NearVolume{"rough", rough}, NearVolume{"gradient", gradient},
                                         NearVolume{"missing", with_missing}),
                         [](const auto& p) { return p.param.name; });

TEST(PackedNearLossless, ReachesAPsnrFarAbove160WithFewerBytesThanLossless) {
  MemoryVolume volume(kPackedDomain, [](const Index3& i) { return i.x < 20 ? 1e4F * rough(i) : rough(i); });
  const std::uint64_t lossless = test::convert(volume, packed(Budget::Kind::lossless, 0)).file.size();
  const Converted converted = test::convert(volume, packed(Budget::Kind::psnr, 190));
  EXPECT_GE(converted.sidecar.error.psnr_db.value_or(0), 190);
  EXPECT_LT(converted.sidecar.error.psnr_db.value_or(1e9), 192);
  EXPECT_LT(converted.file.size(), lossless / 10 * 9);
}

// The background is known only after the survey.
TEST(PackedNearLossless, BlocksWithSomeMissingVoxelsAreNearlyLosslessToo) {
  MemoryVolume volume({{0, 0, 0}, {64, 64, 64}}, with_missing);
  ConversionOptions options = packed(Budget::Kind::psnr, 135);
  options.non_finite = NonFinitePolicy::background;
  const Converted converted = test::convert(volume, options);
  EXPECT_GE(converted.sidecar.error.psnr_db.value_or(0), 135);
  EXPECT_GT((*converted.sidecar.selection.blocks)[1 + static_cast<std::size_t>(PackedKind::lattice)], 300U);
  EXPECT_EQ((*converted.sidecar.selection.blocks)[1 + static_cast<std::size_t>(PackedKind::raw)], 0U);
  expect_certificate(volume, converted, options, "135 dB");
}

}  // namespace
}  // namespace weir::packed_near_lossless_test
