// convert_volume with Certify::gradient. The sidecar gives the same gradient error as a comparison of source and file,
// and the volume is the same as without it.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compressor/derived/derived_error.h"
#include "format/base/error.h"
#include "tests/compressor/support/crash_file_system.h"
#include "tests/compressor/support/pushed.h"
#include "tests/compressor/support/thread_team.h"

namespace weir::certified_gradient_test {
namespace {

const Box kDomain{{-5, 3, -20}, {60, 40, 150}};

float wave(const Index3& i) {
  const float x = static_cast<float>(i.x);
  return std::sin(0.3F * x) + 0.01F * static_cast<float>(i.y * i.z % 17);
}

test::MemoryVolume waves() {
  test::MemoryVolume volume(kDomain, wave);
  volume.info().spacing = {0.5, 1, 4};
  return volume;
}

ConversionOptions certified(Encoding encoding) {
  ConversionOptions options;
  options.encoding = encoding;
  options.budget.kind = Budget::Kind::rate;
  options.budget.rate = 2.5;
  options.certify = Certify::gradient;
  return options;
}

std::string gradient_of(const Sidecar& sidecar) {
  return nlohmann::json::parse(to_json_text(sidecar))["error"]["gradient"].dump();
}

/// Returns the gradient error of a comparison, as text in the sidecar's form.
std::string compared(VolumeSource& source, const NvdbGrid& grid) {
  Sidecar sidecar;
  sidecar.gradient = gradient_error(source, grid, {});
  return gradient_of(sidecar);
}

TEST(CertifiedGradient, EqualsThatOfAComparison_OfEveryEncoding) {
  test::MemoryVolume volume = waves();
  for (const Encoding encoding : {Encoding::automatic, Encoding::float32, Encoding::fpn, Encoding::fp4, Encoding::fp8,
                                  Encoding::fp16, Encoding::packed}) {
    ConversionOptions options = certified(encoding);
    if (encoding == Encoding::fp16) options.budget.rate = 1.5;
    const test::Converted made = test::convert(volume, options);
    ASSERT_TRUE(made.sidecar.gradient) << encoding_name(encoding);
    EXPECT_GT(made.sidecar.gradient->max_abs, 0) << encoding_name(encoding);
    EXPECT_EQ(made.sidecar.gradient->voxels, static_cast<std::uint64_t>(kDomain.voxels()));
    EXPECT_EQ(gradient_of(made.sidecar), compared(volume, made.grid())) << encoding_name(encoding);
    options.certify = Certify::values;
    const test::Converted plain = test::convert(volume, options);
    EXPECT_FALSE(plain.sidecar.gradient);
    EXPECT_TRUE(plain.file == made.file) << encoding_name(encoding);
  }
}

TEST(CertifiedGradient, LeavesOutWhatIsNotFinite) {
  test::MemoryVolume volume(kDomain, [](const Index3& i) {
    return i == Index3{0, 10, 0} ? std::numeric_limits<float>::quiet_NaN() : wave(i);
  });
  for (const NonFinitePolicy policy : {NonFinitePolicy::background, NonFinitePolicy::keep}) {
    ConversionOptions options = certified(Encoding::automatic);
    options.budget.kind = Budget::Kind::psnr;
    options.budget.target = 40;
    options.non_finite = policy;
    const test::Converted made = test::convert(volume, options);
    ASSERT_TRUE(made.sidecar.gradient);
    EXPECT_GE(made.sidecar.gradient->left_out, 6U);
    EXPECT_EQ(gradient_of(made.sidecar), compared(volume, made.grid()));
  }
}

TEST(CertifiedGradient, OfAPushedVolume) {
  test::MemoryVolume volume = waves();
  const ConversionOptions options = certified(Encoding::fpn);
  const test::Converted pushed =
      test::push(volume.info(), std::as_bytes(volume.values()), options, test::slabs_in_order(kDomain.extent().z, 7));
  EXPECT_EQ(gradient_of(pushed.sidecar), compared(volume, pushed.grid()));
}

TEST(CertifiedGradient, TheSameByHoweverManyProcesses) {
  test::MemoryVolume volume = waves();
  const test::Converted made = test::convert(volume, certified(Encoding::fpn));
  const NvdbGrid grid = made.grid();
  const GradientError alone = gradient_error(volume, grid, {});
  for (const int ranks : {2, 5}) {
    std::atomic<int> equal{0};
    ThreadTeam(ranks).run([&](Team& team) {
      CompareOptions small;
      small.block_bytes = std::uint64_t{64} << 10U;
      const GradientError found = gradient_error(volume, grid, small, team);
      equal += found.rms == alone.rms && found.relative_rms == alone.relative_rms && found.max_abs == alone.max_abs &&
               found.voxels == alone.voxels && found.left_out == alone.left_out;
    });
    EXPECT_EQ(equal, ranks);
  }
}

TEST(CertifiedGradient, Interrupted_LeavesNothing) {
  test::MemoryVolume volume = waves();
  test::CrashFileSystem files;
  ConversionOptions options = certified(Encoding::fpn);
  options.output = "out.nvdb";
  std::atomic<bool> cancel{false};
  ConversionControl control;
  control.cancel = &cancel;
  std::vector<std::string> passes;
  control.pass_started = [&](const std::string& pass, std::uint64_t bytes) {
    passes.push_back(pass);
    EXPECT_EQ(bytes, static_cast<std::uint64_t>(kDomain.voxels()) * sizeof(float));
    cancel = pass == "certify";
  };
  try {
    convert_volume(volume, options, control, files);
    ADD_FAILURE() << "not interrupted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::interrupted);
    EXPECT_STREQ(error.what(), "interrupted; nothing was written");
  }
  EXPECT_EQ(passes, (std::vector<std::string>{"survey", "encode", "certify"}));
  EXPECT_EQ(files.names(), (std::vector<std::string>{}));
}

}  // namespace
}  // namespace weir::certified_gradient_test
