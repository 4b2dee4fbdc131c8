#include "compressor/forecast/sample_scale.h"

#include <gtest/gtest.h>

#include "compressor/select/fixed_bytes.h"

namespace weir::sample_scale_test {
namespace {

const Box kVolume{{0, 0, 0}, {1024, 1024, 1024}};
const Box kSample{{0, 0, 0}, {1024, 256, 256}};

const SampledNodes kNodes{480, 30};

std::uint64_t fixed(const Box& domain, const ConversionOptions& options, std::uint64_t nodes) {
  return fixed_bytes(domain, options.encoding, options.preview, 0, nodes);
}

TEST(SampleScale, Size_LeavesTheSampleTheSameBytesForEachLeaf) {
  for (const Encoding encoding : {Encoding::fpn, Encoding::packed}) {
    ConversionOptions options;
    options.encoding = encoding;
    options.preview = Preview::on;
    options.budget.kind = Budget::Kind::size;
    options.budget.bytes = 200000000;
    const SampleScale scale(kVolume, kSample, options, kNodes);
    EXPECT_EQ(scale.share(), 1.0 / 16);
    const Budget budget = scale.budget();
    EXPECT_EQ(budget.kind, Budget::Kind::size);
    const double of_volume = 200000000.0 - static_cast<double>(fixed(kVolume, options, 480));
    const double of_sample = static_cast<double>(budget.bytes) - static_cast<double>(fixed(kSample, options, 30));
    EXPECT_NEAR(of_sample, of_volume / 16, 1);
  }
}

TEST(SampleScale, Rate_BecomesASize) {
  ConversionOptions options;
  options.encoding = Encoding::float32;
  const SampleScale scale(kVolume, kSample, options, kNodes);  // rate 8, the default
  EXPECT_EQ(scale.budget().kind, Budget::Kind::size);
  EXPECT_NEAR(static_cast<double>(scale.budget().bytes), 1024.0 * 256 * 256 * 4 / 8, 3e5);
}

TEST(SampleScale, ErrorTargets_StayAsTheyAre) {
  ConversionOptions options;
  options.budget.kind = Budget::Kind::psnr;
  options.budget.target = 60;
  const Budget budget = SampleScale(kVolume, kSample, options, kNodes).budget();
  EXPECT_EQ(budget.kind, Budget::Kind::psnr);
  EXPECT_EQ(budget.target, 60);
}

TEST(SampleScale, FileBytes_AreTheInverseOfTheBudget) {
  ConversionOptions options;
  options.encoding = Encoding::fpn;
  options.budget.kind = Budget::Kind::size;
  options.budget.bytes = 123456789;
  const SampleScale scale(kVolume, kSample, options, kNodes);
  Sidecar of_sample;
  of_sample.file.bytes = scale.budget().bytes;
  EXPECT_NEAR(scale.file_bytes(of_sample), 123456789, 16);
}

TEST(SampleScale, AllOfAVolume_IsItself) {
  ConversionOptions options;
  const SampleScale scale(kVolume, kVolume, options, kNodes);
  EXPECT_EQ(scale.budget().kind, Budget::Kind::automatic);
  Sidecar sidecar;
  sidecar.file.bytes = 4711;
  EXPECT_EQ(scale.file_bytes(sidecar), 4711);
}

}  // namespace
}  // namespace weir::sample_scale_test
