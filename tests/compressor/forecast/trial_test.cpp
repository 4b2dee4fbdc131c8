#include "compressor/forecast/trial.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "format/io/memory_file_system.h"
#include "tests/compressor/support/memory_volume.h"
#include "tests/support/run_command.h"

namespace weir::trial_test {
namespace {

float wave(const Index3& i) { return std::sin(0.3F * static_cast<float>(i.x)) + 0.1F * static_cast<float>(i.y % 7); }

class TrialTest : public testing::Test {
 protected:
  static Trial certified_in(FileSystem& files, const std::string& output) {
    test::MemoryVolume volume({{0, 0, 0}, {30, 20, 17}}, wave);
    ConversionOptions options;
    options.output = output;
    options.budget.kind = Budget::Kind::psnr;
    options.budget.target = 40;
    options.certify = Certify::gradient;
    return run_trial(volume, options, {}, files);
  }

  TemporaryDirectory directory_;
  std::string output_ = directory_ / "out.nvdb";
  std::unique_ptr<FileSystem> disk_ = make_posix_file_system();
};

TEST_F(TrialTest, CertifiedGradient_IsOfTheTrialsOwnFile) {
  MemoryFileSystem memory;
  const Trial in_memory = certified_in(memory, "out.nvdb");
  ASSERT_TRUE(in_memory.sidecar.gradient);
  EXPECT_GT(in_memory.sidecar.gradient->rms, 0);
  const Trial on_disk = certified_in(*disk_, output_);
  EXPECT_EQ(on_disk.sidecar.gradient->rms, in_memory.sidecar.gradient->rms);
  EXPECT_TRUE(list_directory(directory_.path()).empty());
}

TEST_F(TrialTest, FileOfAnotherConversion_IsNotRead) {
  const std::string partial = output_ + ".partial";
  write_file(partial, "somebody's");
  const Trial trial = certified_in(*disk_, output_);
  ASSERT_TRUE(trial.sidecar.gradient);
  EXPECT_EQ(read_file(partial), "somebody's");
  EXPECT_EQ(list_directory(directory_.path()), std::vector<std::string>{"out.nvdb.partial"});
}

}  // namespace
}  // namespace weir::trial_test
