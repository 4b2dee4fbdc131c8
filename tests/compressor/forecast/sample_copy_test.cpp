#include "compressor/forecast/sample_copy.h"

#include <gtest/gtest.h>

#include <atomic>
#include <span>
#include <vector>

#include "compressor/forecast/sampled_source.h"
#include "tests/compressor/support/memory_volume.h"
#include "tests/support/message_of_error.h"
#include "tests/support/run_command.h"

namespace weir::sample_copy_test {
namespace {

using test::MemoryVolume;

class SampleCopyTest : public testing::Test {
 protected:
  std::unique_ptr<File> file() { return files_->create_unnamed(directory_.path()); }

  MemoryVolume volume_{{{-4, 3, 0}, {136, 270, 260}},
                       [](const Index3& i) { return static_cast<float>(i.x + 1000 * i.y + 1000000 * i.z); }};
  SamplePlan plan_{volume_.info().domain(), {}, 140 * 128 * 128, 1};
  TemporaryDirectory directory_;
  std::unique_ptr<FileSystem> files_ = make_posix_file_system();
};

TEST_F(SampleCopyTest, HoldsTheValuesOfTheSample) {
  SampledSource sample(volume_, plan_);
  const Box all = sample.info().domain();
  ASSERT_EQ(plan_.places(), 16 * 16);
  SampleCopy copy(sample, file(), 1 << 20U, nullptr);
  EXPECT_EQ(copy.info().domain(), all);
  EXPECT_EQ(sample.voxels_read(), all.voxels());
  for (const Box& box : {all, Box{all.lo + Index3{0, 5, 7}, all.hi - Index3{0, 3, 1}},
                         Box{all.lo + Index3{3, 5, 7}, all.hi - Index3{9, 3, 1}}}) {
    std::vector<float> expected(static_cast<std::size_t>(box.voxels()));
    std::vector<float> values(expected.size());
    sample.read(box, expected);
    copy.read(box, values);
    EXPECT_EQ(values, expected);
  }
  EXPECT_TRUE(list_directory(directory_.path()).empty());
}

/// A volume that reports for each read that one value was rounded by an eighth.
class RoundedVolume final : public VolumeSource {
 public:
  explicit RoundedVolume(VolumeSource& source) : source_(source) {}
  const SourceInfo& info() const override { return source_.info(); }
  AccessShape access() const override { return source_.access(); }
  ConversionLoss read(const Box& box, std::span<float> values) override {
    source_.read(box, values);
    ++reads_;
    return {1, 0, 0.125};
  }
  std::uint64_t bytes_read() const override { return source_.bytes_read(); }
  std::uint64_t reads() const { return reads_; }

 private:
  VolumeSource& source_;
  std::atomic<std::uint64_t> reads_{0};
};

TEST_F(SampleCopyTest, KnowsWhatItsValuesLost) {
  RoundedVolume rounded(volume_);
  SampledSource sample(rounded, plan_);
  const SampleCopy copy(sample, file(), 1 << 20U, nullptr);
  EXPECT_GT(rounded.reads(), 0U);
  EXPECT_EQ(copy.copied_loss().inexact, rounded.reads());
  EXPECT_EQ(copy.copied_loss().max_abs_error, 0.125);
}

TEST_F(SampleCopyTest, PartsOfTheSample_AreReadFromIt) {
  SampledSource sample(volume_, plan_);
  SampleCopy copy(sample, file(), 1 << 20U, nullptr);
  const std::uint64_t read = volume_.bytes_read();
  std::vector<std::vector<float>> of_copy;
  for (const SamplePlan& part : plan_.parts()) {
    SampledSource source(copy, part, SampledSource::From::copy);
    std::vector<float> values(static_cast<std::size_t>(source.info().domain().voxels()));
    source.read(source.info().domain(), values);
    of_copy.push_back(values);
  }
  EXPECT_EQ(volume_.bytes_read(), read);
  ASSERT_EQ(of_copy.size(), 8U);
  for (std::size_t i = 0; i < of_copy.size(); ++i) {
    SampledSource source(volume_, plan_.parts()[i]);
    std::vector<float> values(of_copy[i].size());
    source.read(source.info().domain(), values);
    EXPECT_EQ(of_copy[i], values) << i;
  }
}

TEST_F(SampleCopyTest, Cancelled_IsInterrupted) {
  SampledSource sample(volume_, plan_);
  const std::atomic<bool> cancel = true;
  EXPECT_EQ(message_of_error(ErrorKind::interrupted, [&] { SampleCopy(sample, file(), 1 << 20U, &cancel); }),
            "interrupted; nothing was written");
}

}  // namespace
}  // namespace weir::sample_copy_test
