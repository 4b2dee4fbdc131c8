#include "tools/sweep/zfp_trial.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "compressor/leaf/exact_sum.h"
#include "format/base/error.h"
#include "format/process/process_memory.h"
#include "ingest/source/source_view.h"
#include "ingest/synthetic/synthetic.h"
#include "tests/support/temporary_directory.h"
#include "tools/sweep/zfp_codec.h"

namespace weir::zfp_trial_test {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;

class ZfpTrialTest : public testing::Test {
 protected:
  ZfpTrial run(VolumeSource& source, unsigned bits, std::uint64_t memory = 1024 * kMiB,
               const ConversionControl& control = {}) {
    return try_zfp(source, {bits, memory, directory_.path().string()}, control, *files_);
  }
  ZfpTrial run(const std::string& kind, const Index3& extent, unsigned bits) {
    return run(*open_synthetic(kind, {extent, 1}), bits);
  }

  TemporaryDirectory directory_;
  std::unique_ptr<FileSystem> files_ = make_posix_file_system();
};

// Returns the error when the codec takes the whole array at once.
Certificate in_one_piece(VolumeSource& source, unsigned bits) {
  const Index3 extent = source.info().extent;
  std::vector<float> values(static_cast<std::size_t>(volume(extent)));
  source.read(source.info().domain(), values);
  ZfpCodec codec(bits);
  codec.compress({values.data(), extent, extent});
  const std::span<const float> decoded = codec.decompress(extent);
  ExactSum sum;
  double max_abs = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double difference = static_cast<double>(values[i]) - static_cast<double>(decoded[i]);
    sum.add(difference * difference);
    max_abs = std::max(max_abs, std::abs(difference));
  }
  const auto [min, max] = std::minmax_element(values.begin(), values.end());
  return make_certificate(sum.value(), max_abs, max_abs == 0, values.size(), *min, *max);
}

void expect_equal(const Certificate& a, const Certificate& b) {
  EXPECT_EQ(a.mse, b.mse);
  EXPECT_EQ(a.nmse, b.nmse);
  EXPECT_EQ(a.psnr_db, b.psnr_db);
  EXPECT_EQ(a.max_abs, b.max_abs);
  EXPECT_EQ(a.lossless, b.lossless);
}

TEST_F(ZfpTrialTest, PiecewiseErrorEqualsThatInOnePiece) {
  for (const Index3 extent : {Index3{61, 50, 43}, Index3{1, 1, 3000}, Index3{5000, 3, 2}, Index3{4, 4, 4}}) {
    const auto source = open_synthetic("turbulence", {extent, 1});
    const ZfpTrial trial = run(*source, 128);
    EXPECT_EQ(trial.bytes, zfp_stream_bytes(extent, 128));
    EXPECT_EQ(trial.nonfinite, 0U);
    EXPECT_EQ(trial.nonfinite_decoded, 0U);
    EXPECT_GT(trial.seconds, 0.0);
    EXPECT_GT(trial.error.mse, 0.0);
    expect_equal(trial.error, in_one_piece(*source, 128));
  }
}

// The volumes have several blocks with several pieces each, and a piece cut in x.
TEST_F(ZfpTrialTest, SameErrorWhateverMemoryThreadsAndBlocks) {
  for (const Index3 extent : {Index3{201, 150, 99}, Index3{40000, 21, 4}}) {
    const auto source = open_synthetic("turbulence", {extent, 1});
    const Certificate expected = in_one_piece(*source, 70);
    for (const std::size_t threads : {1U, 3U}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      expect_equal(run(*source, 70, resident_bytes() + (24 + 4 * threads) * kMiB).error, expected);
    }
    expect_equal(run(*source, 70).error, expected);
  }
}

// ZFP's blocks begin at the region's corner, wherever that lies in the source's leaves.
TEST_F(ZfpTrialTest, RegionErrorEqualsThatInOnePiece) {
  const auto region = crop_source(open_synthetic("turbulence", {{70, 60, 50}, 1}), {{3, 5, 9}, {64, 52, 50}});
  expect_equal(run(*region, 100).error, in_one_piece(*region, 100));
}

TEST_F(ZfpTrialTest, ConstantComesBackExactly) {
  const ZfpTrial trial = run("zero", {20, 20, 20}, 64);
  EXPECT_TRUE(trial.error.lossless);
  EXPECT_EQ(trial.error.psnr_db, std::nullopt);
}

TEST_F(ZfpTrialTest, NonFiniteVoxelsAreCounted) {
  EXPECT_EQ(run("some-nan", {97, 10, 10}, 64).nonfinite, 300U);
  EXPECT_EQ(run("nan", {9, 9, 9}, 64).nonfinite, 729U);
}

TEST_F(ZfpTrialTest, HardValues) {
  for (const char* kind : {"huge", "denormal", "offset", "hot-voxel", "checkerboard", "plateau", "negative-zero"}) {
    const ZfpTrial trial = run(kind, {33, 18, 20}, 128);
    EXPECT_EQ(trial.nonfinite, 0U) << kind;
    EXPECT_TRUE(std::isfinite(trial.error.mse)) << kind;
  }
}

TEST_F(ZfpTrialTest, LeavesNothingBehind) {
  run("cloud", {20, 20, 20}, 64);
  EXPECT_TRUE(std::filesystem::is_empty(directory_.path()));
}

TEST_F(ZfpTrialTest, Refusals) {
  const auto source = open_synthetic("cloud", {{20, 20, 20}, 1});
  try {
    run(*source, 64, kMiB);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    EXPECT_EQ(std::string(error.what()).find("--memory 1.0 MiB is too small for ZFP with "), 0U) << error.what();
  }
  const std::atomic<bool> cancel{true};
  ConversionControl control;
  control.cancel = &cancel;
  try {
    run(*source, 64, 1024 * kMiB, control);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::interrupted);
  }
}

}  // namespace
}  // namespace weir::zfp_trial_test
