// What the blocks of a region share in a packed file: the value of blocks without a stream, and the codes for the means
// of all other blocks.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "tests/compressor/support/converted.h"
#include "tests/compressor/support/memory_volume.h"
#include "tests/compressor/support/packed_files.h"

namespace weir::packed_regions_test {
namespace {

using test::Converted;
using test::expect_certificate;
using test::MemoryVolume;
using test::packed;

constexpr Box kCube{{0, 0, 0}, {64, 64, 64}};

float rough(const Index3& i) {
  const auto x = static_cast<float>(i.x);
  const auto y = static_cast<float>(i.y);
  const auto z = static_cast<float>(i.z);
  return std::sin(0.11F * x + 0.05F * y) * std::cos(0.08F * z) + 0.1F * std::sin(2.1F * x + 1.7F * y + 2.9F * z);
}

// Returns a volume of which a quarter is filled with `fill`, behind a border that lies across blocks.
MemoryVolume partly_filled(float fill) {
  return {kCube, [fill](const Index3& i) { return 10 * i.x + 7 * i.y > 700 ? fill : rough(i); }};
}

// Returns a volume that is nearly constant, except for one block of zeros.
MemoryVolume nearly_constant() {
  return {kCube, [](const Index3& i) { return i.x < 8 && i.y < 8 && i.z < 8 ? 0.0F : 100 + 1e-3F * rough(i); }};
}

TEST(PackedRegions, WhereFillValuesAreFarFromTheOthers_TheOthersAreMeans) {
  const ConversionOptions options = packed(Budget::Kind::psnr, 60);
  MemoryVolume near_volume = partly_filled(1e6F);
  const std::size_t bytes = test::convert(near_volume, options).file.size();
  for (const float fill : {1e9F, 1e15F, 1e20F, -1e20F}) {
    MemoryVolume volume = partly_filled(fill);
    const Converted converted = test::convert(volume, options);
    const std::string what = std::to_string(std::log10(std::fabs(fill)));
    EXPECT_LE(converted.file.size(), bytes + bytes / 8) << what;
    EXPECT_GE(converted.sidecar.error.psnr_db.value_or(1000), 60) << what;
    expect_certificate(volume, converted, options, what);
  }
}

TEST(PackedRegions, OneVoxelFarFromTheOthers_IsExactAndTheOthersAreMeans) {
  constexpr Index3 kOdd{21, 13, 37};
  std::size_t bytes = 0;
  for (const float odd : {1e6F, 1e12F, 1e20F}) {
    MemoryVolume volume(kCube, [&](const Index3& i) { return i == kOdd ? odd : rough(i); });
    const ConversionOptions options = packed(Budget::Kind::psnr, 100);
    const Converted converted = test::convert(volume, options);
    if (bytes == 0) bytes = converted.file.size();
    EXPECT_LE(converted.file.size(), bytes + bytes / 8) << odd;
    expect_certificate(volume, converted, options, std::to_string(odd));
  }
}

TEST(PackedRegions, InTheSmallestFile_OneBlockOfOneValueIsNotReadEverywhere) {
  constexpr Box kOneMore{{0, 0, 0}, {65, 65, 65}};  // the last block has one voxel, so it has one value
  MemoryVolume volume(kOneMore, [](const Index3& i) { return i == Index3{64, 64, 64} ? 0.0F : 100 + rough(i); });
  const ConversionOptions options = packed(Budget::Kind::size, 0);
  const Converted converted = test::convert_to(volume, options, test::minimum_size(volume, options));
  EXPECT_LE(converted.sidecar.error.mse, converted.sidecar.error_preview->mse * 1.000001);
  expect_certificate(volume, converted, options, "smallest");
}

TEST(PackedRegions, NearlyConstantButForOneBlock_ThatBlockAloneHasAStream) {
  MemoryVolume volume = nearly_constant();
  const ConversionOptions options = packed(Budget::Kind::psnr, 70);
  const Converted converted = test::convert(volume, options);
  EXPECT_EQ(converted.sidecar.selection.leaves_kept, 1U);
  expect_certificate(volume, converted, options, "nearly constant");
}

TEST(PackedRegions, BlocksOfTheBackgroundThatAreMany_HaveNoStream) {
  const auto value = [](const Index3& i) { return i.x < 24 ? 0.0F : 100 + 10 * rough(i); };
  MemoryVolume volume(kCube, value);
  const ConversionOptions options = packed(Budget::Kind::psnr, 60);
  const Converted converted = test::convert(volume, options);
  EXPECT_EQ(converted.sidecar.selection.leaves_kept, 5U * 8 * 8);
  expect_certificate(volume, converted, options, "background");
}

TEST(PackedRegions, WithinALargestError_BlocksThatReadTheMedianHaveNoStream) {
  MemoryVolume volume = nearly_constant();
  const ConversionOptions options = packed(Budget::Kind::max_error, 0.01);
  const Converted converted = test::convert(volume, options);
  EXPECT_EQ(converted.sidecar.selection.leaves_kept, 1U);
  EXPECT_LE(converted.sidecar.error.max_abs, 0.01);
  expect_certificate(volume, converted, options, "largest error");
}

}  // namespace
}  // namespace weir::packed_regions_test
