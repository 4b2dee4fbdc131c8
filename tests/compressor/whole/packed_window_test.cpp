// Packed files of volumes that are large enough for a look ahead (compressor/look_ahead.h). The bytes are the same with
// and without it, when the volume is pushed, and when the sampled blocks mislead.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "compressor/outlook/budget_outlook.h"
#include "compressor/packed/block_sample.h"
#include "tests/compressor/support/converted.h"
#include "tests/compressor/support/memory_volume.h"
#include "tests/compressor/support/packed_files.h"
#include "tests/compressor/support/pushed.h"

namespace weir::packed_window_test {
namespace {

using test::Converted;
using test::expect_certificate;
using test::MemoryVolume;
using test::packed;

constexpr Box kDomain{{-5, 2, 8}, {211, 210, 209}};

float hash(const Index3& i) {
  auto h = static_cast<std::uint32_t>(i.x * 73856093 ^ i.y * 19349663 ^ i.z * 83492791);
  h ^= h >> 15U;
  h *= 0x2C1B3C6DU;
  h ^= h >> 12U;
  return static_cast<float>(h % 65536) / 65536 - 0.5F;
}

float waves(const Index3& i) {
  const auto x = static_cast<float>(i.x), y = static_cast<float>(i.y), z = static_cast<float>(i.z);
  const float smooth = std::sin(x * 0.11F) * std::cos(y * 0.07F + z * 0.05F);
  return std::max(0.0F, smooth + 0.1F * std::sin(z * 0.9F + x)) + (i.y > 100 ? 0.02F * hash(i) : 0);
}

// Returns values that are flat in the sampled blocks, or flat everywhere except in the sampled blocks.
float misleading(const Index3& i, bool flat_sample) {
  static const NodeLattice leaves = make_lattice(kDomain, kLeafDim);
  static const BlockSample sample(leaves);
  const bool sampled = sample.has(floor_div(i, kLeafDim) - leaves.first);
  const float detail = sampled == flat_sample ? 0.001F : 1.0F;
  return static_cast<float>(i.x) * 0.001F + detail * (0.3F * hash(i) + waves(i));
}

std::vector<std::byte> bytes_of(const MemoryVolume& volume) {
  const auto bytes = std::as_bytes(volume.values());
  return {bytes.begin(), bytes.end()};
}

// Converts with a look ahead, without one on one thread with less memory, and by a push.
void expect_same_every_way(MemoryVolume& volume, const ConversionOptions& options, const std::string& what) {
  ASSERT_GE(make_lattice(kDomain, kLeafDim).size(), kLeastForecastBlocks);
  const Converted ahead = test::convert(volume, options);
  expect_certificate(volume, ahead, options, what);
  // The sample lies in all chunks, so a look ahead would decode all of them.
  const Index3 extent = kDomain.extent();
  volume.set_access({4, {extent.x, extent.y, 8}, kDomain.lo});
  ConversionOptions other = options;
  other.threads = 1;
  other.memory = std::uint64_t{224} << 20U;
  EXPECT_TRUE(test::convert(volume, other).file == ahead.file) << what << ", no look ahead";
  volume.set_access({});
  const Converted pushed = test::push(volume.info(), bytes_of(volume), options, test::slabs_in_order(extent.z, 40));
  EXPECT_TRUE(pushed.file == ahead.file) << what << ", pushed";
}

TEST(PackedWindow, BytesAreTheSameWithALookAheadAndWithout) {
  MemoryVolume volume(kDomain, waves);
  expect_same_every_way(volume, packed(Budget::Kind::rate, 60), "rate 60");
  expect_same_every_way(volume, packed(Budget::Kind::psnr, 130), "130 dB");
}

// The sample decides about the preview as the plan would, and decides the same however the volume is surveyed.
TEST(PackedWindow, AFileThatIsFarTooShortHasNoPreviewHoweverItIsMade) {
  MemoryVolume volume(kDomain, waves);
  ConversionOptions options = packed(Budget::Kind::psnr, 30);
  options.preview = Preview::automatic;
  expect_same_every_way(volume, options, "30 dB");
  const Converted made = test::convert(volume, options);
  EXPECT_FALSE(made.sidecar.packed->preview);
  options.preview = Preview::off;
  EXPECT_TRUE(test::convert(volume, options).file == made.file);
  options.preview = Preview::automatic;
  options.budget.target = 140;
  EXPECT_TRUE(test::convert(volume, options).sidecar.packed->preview);
}

TEST(PackedWindow, ASampleThatMisleadsCostsTimeAlone) {
  for (const bool flat : {false, true}) {
    MemoryVolume volume(kDomain, [&](const Index3& i) { return misleading(i, flat); });
    const ConversionOptions options = flat ? packed(Budget::Kind::psnr, 45) : packed(Budget::Kind::rate, 20);
    expect_same_every_way(volume, options, flat ? "flat sample" : "all but the sample flat");
    if (!flat) continue;
    const double reached = test::convert(volume, options).sidecar.error.psnr_db.value_or(0);
    EXPECT_GE(reached, 45);
    EXPECT_LT(reached, 45.2);
  }
}

TEST(PackedWindow, MoreBytesNeverLoseMore) {
  MemoryVolume volume(kDomain, waves);
  double last = 1e300;
  for (double rate = 300; rate > 5; rate /= 1.4) {
    const Converted converted = test::convert(volume, packed(Budget::Kind::rate, rate));
    EXPECT_LE(converted.sidecar.error.mse, last * 1.001) << rate;
    last = converted.sidecar.error.mse;
  }
}

}  // namespace
}  // namespace weir::packed_window_test
